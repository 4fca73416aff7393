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
  void mark_steps(const GroundView& ground);
  [[nodiscard]] double hole_depth_m(const GroundView& ground, const HoleParameters& holes, std::int32_t x,
                                    std::int32_t y) const;
  void find_pits(const HoleParameters& holes, const GroundView& ground, const LayerArrays& out);

  std::vector<std::uint8_t> steps_;  // bits of `StepMark`: as the middle column of a step
  std::vector<float> rim_m_;         // `rim_height_m` of the columns
  std::vector<std::uint8_t> shows_;  // 1: a hole shows in the column
};

}  // namespace gvom::cpu
