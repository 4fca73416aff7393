// Negative obstacles (R13) on the CPU, a row of columns at a time.
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

  /// Reads `height` and `inferred_height`; writes `negative_delta` and the flag NEGATIVE.
  void find(const ColumnParameters& p, const LayerArrays& out);

 private:
  bool find_seen_through(std::int32_t y, const LayerArrays& out);

  std::int32_t n_xy_;
  std::vector<std::int16_t> along_x_;
  std::vector<std::int16_t> along_y_;
  std::vector<std::int16_t> after_;     // of one row: offset to the nearest height further on in y
  std::vector<std::int16_t> found_;     // [direction][x] of one row: distances, 0: none
  std::vector<std::int32_t> searched_;  // x of the columns of one row that were seen through
};

}  // namespace gvom::cpu
