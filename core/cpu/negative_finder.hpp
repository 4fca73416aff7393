// Negative obstacles of all columns (R13) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"
#include "core/format/layers.hpp"
#include "core/negative.hpp"

namespace gvom::cpu {

class NegativeFinder {
 public:
  explicit NegativeFinder(std::int32_t n_xy);

  /// Writes `negative_delta` and the flag NEGATIVE.
  void find(const ColumnParameters& p, const GroundView& ground, const LayerArrays& out);

 private:
  void find_pits(const HoleParameters& holes, const GroundView& ground, const LayerArrays& out);

  std::vector<float> rim_m_;         // `rim_height_m` of the columns
  std::vector<std::uint8_t> shows_;  // 1: a hole shows in the column
};

}  // namespace gvom::cpu
