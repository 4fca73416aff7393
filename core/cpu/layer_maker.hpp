// From the fused map to layers (R9..R16) on the CPU.
#pragma once

#include <cstdint>

#include "core/column.hpp"
#include "core/cpu/ground_finder.hpp"
#include "core/cpu/negative_finder.hpp"
#include "core/cpu/obstacle_finder.hpp"
#include "core/cpu/plane_fitter.hpp"
#include "core/format/layers.hpp"

namespace gvom::cpu {

class LayerMaker {
 public:
  explicit LayerMaker(const MapperConfig& config);

  /// Writes every value of every layer; allocates nothing. @param window of which `map` is the sum
  void make(const FusedView& map, const Window& window, const LayerArrays& out);

 private:
  MapperConfig config_;
  std::int32_t n_xy_;
  GroundFinder ground_;
  ObstacleFinder obstacles_;
  PlaneFitter planes_;
  NegativeFinder negatives_;
};

}  // namespace gvom::cpu
