// Half two of the pipeline on the CPU.
#pragma once

#include "core/backend.hpp"
#include "core/cpu/fused_map.hpp"
#include "core/cpu/layer_maker.hpp"

namespace gvom::cpu {

class Fusion : public FusionBackend {
 public:
  explicit Fusion(const MapperConfig& config) : map_(config), layer_maker_(config) {}

  DeviceExpected<AddResult> add(const WindowMap& map) override { return map_.add(map); }
  DeviceExpected<void> make_layers(const LayerArrays& out) override {
    layer_maker_.make(map_.view(), window(), out);
    return {};
  }
  DeviceExpected<BrickMapShape> count_voxels() override { return map_.shape(); }
  DeviceExpected<void> write_voxels(const BrickMapArrays& out) override {
    map_.write(out);
    return {};
  }
  void reset() override { map_.reset(); }
  [[nodiscard]] const Window& window() const override { return map_.window(); }

  [[nodiscard]] const FusedMap& map() const { return map_; }

 private:
  FusedMap map_;
  LayerMaker layer_maker_;
};

}  // namespace gvom::cpu
