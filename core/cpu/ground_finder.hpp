// The ground of all columns (R9, R10, R15) on the CPU, a row of columns at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"
#include "core/column_grid.hpp"
#include "core/format/layers.hpp"

namespace gvom::cpu {

class GroundFinder {
 public:
  GroundFinder(std::int32_t n_xy, double resolution_m);

  /// Writes `height`, `inferred_height`, `last_seen`, `visibility` and, in `flags`, ASSUMED or nothing.
  void find(const FusedView& map, const ColumnParameters& p, const LayerArrays& out);

  /// What was found, until the next call.
  [[nodiscard]] GroundView view() const {
    return {grid_, lowest_ray_m_.data(), ground_m_.data(), is_rim_.data()};
  }

 private:
  void read_columns(const FusedView& map, const ColumnParameters& p, const LayerArrays& out);
  void find_rims();
  void write_heights(const ColumnParameters& p, const LayerArrays& out);
  void ask_around(const ColumnParameters& p, std::int32_t at, std::int32_t i, const LayerArrays& out);

  ColumnGrid grid_;
  std::vector<float> allowed_rise_m_;  // [line][distance - 1]
  std::vector<float> cone_rise_m_;     // [distance]
  std::vector<float> lowest_ray_m_, ground_m_, lowest_m_, cone_m_;
  std::vector<std::uint8_t> is_rim_, standing_;
  std::vector<std::int8_t> votes_, row_votes_;
  std::vector<float> cone_row_m_;
  std::vector<std::uint8_t> asks_around_;
};

}  // namespace gvom::cpu
