// From the fused map to layers (R9..R16) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"
#include "core/cpu/plane_fitter.hpp"
#include "core/layers.hpp"
#include "core/negative.hpp"

namespace gvom::cpu {

class LayerMaker {
 public:
  explicit LayerMaker(const MapperConfig& config);

  /// Writes every value of every layer; allocates nothing.
  void make(const FusedView& map, const LayerMoment& moment, const LayerArrays& out);

 private:
  void find_nearest_heights(const float* height);

  MapperConfig config_;
  std::int32_t n_xy_;
  std::vector<std::int16_t> along_x_;
  std::vector<std::int16_t> along_y_;
  PlaneFitter planes_;
};

}  // namespace gvom::cpu
