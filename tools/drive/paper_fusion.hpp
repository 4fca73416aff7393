// Core's fusion with one rule as the paper has it, and all others as they are.
#pragma once

#include "core/backend.hpp"
#include "core/cpu/fused_map.hpp"
#include "core/cpu/ground_finder.hpp"
#include "core/cpu/negative_finder.hpp"
#include "core/cpu/obstacle_finder.hpp"
#include "core/cpu/plane_fitter.hpp"
#include "tools/drive/paper_rules.hpp"

namespace gvom::driving {

enum class PaperRule : std::uint8_t { r9, r13 };

class PaperFusion : public FusionBackend {
 public:
  PaperFusion(const MapperConfig& config, PaperRule rule);

  DeviceExpected<AddResult> add(const WindowMap& map) override { return map_.add(map); }
  DeviceExpected<void> make_layers(const LayerArrays& out) override;
  DeviceExpected<BrickMapShape> count_voxels() override { return map_.shape(); }
  DeviceExpected<void> write_voxels(const BrickMapArrays& out) override {
    map_.write(out);
    return {};
  }
  void reset() override { map_.reset(); }
  [[nodiscard]] const Window& window() const override { return map_.window(); }

 private:
  MapperConfig config_;
  PaperRule rule_;
  cpu::FusedMap map_;
  cpu::GroundFinder ground_;
  cpu::ObstacleFinder obstacles_;
  cpu::PlaneFitter planes_;
  cpu::NegativeFinder negatives_;
  PaperGround paper_ground_;
  PaperHoles paper_holes_;
};

}  // namespace gvom::driving
