// The line from a column to the vehicle and away from it, for host and device: whole columns along the
// longer axis.
#pragma once

#include "core/column_grid.hpp"

namespace gvom {

class SightLine {
 public:
  GVOM_HD SightLine(const ColumnGrid& grid, std::int32_t x, std::int32_t y, std::int32_t vehicle_x,
                    std::int32_t vehicle_y)
      : x_(x), y_(y), n_xy_(grid.n_xy), at_(grid.at(x, y)) {
    const std::int32_t dx = vehicle_x - x, dy = vehicle_y - y;
    const std::int32_t along_x = dx < 0 ? -dx : dx, along_y = dy < 0 ? -dy : dy;
    by_x_ = along_x >= along_y;
    columns_ = by_x_ ? along_x : along_y;
    major_ = (by_x_ ? dx : dy) < 0 ? -1 : 1;
    const std::int32_t minor = by_x_ ? dy : dx;
    slope_ = columns_ == 0 ? 0 : minor * 65536 / columns_;
    columns_square_ = dx * dx + dy * dy;
    along_at_ = by_x_ ? major_ : major_ * grid.pitch();
    beside_ = by_x_ ? grid.pitch() : 1;
  }

  /// Columns along the longer axis to the vehicle's.
  [[nodiscard]] GVOM_HD std::int32_t columns() const { return columns_; }
  /// Length of a step, metres.
  [[nodiscard]] GVOM_HD double step_m(double resolution_m) const {
    return resolution_m * std::sqrt(static_cast<double>(columns_square_)) / columns_;
  }
  /// Index of the column `steps` towards the vehicle (negative: away from it). It is in the grid.
  [[nodiscard]] GVOM_HD std::int32_t at(std::int32_t steps) const {
    return at_ + steps * along_at_ + across(steps) * beside_;
  }
  /// Whether `steps` leads no farther than `margin` columns out of the grid. If so, all steps before it do.
  [[nodiscard]] GVOM_HD bool reaches(std::int32_t steps, std::int32_t margin) const {
    const std::int32_t x = x_ + (by_x_ ? steps * major_ : across(steps));
    const std::int32_t y = y_ + (by_x_ ? across(steps) : steps * major_);
    return x >= -margin && y >= -margin && x < n_xy_ + margin && y < n_xy_ + margin;
  }
  /// From the middle column of a step to the one beside it.
  [[nodiscard]] GVOM_HD std::int32_t beside() const { return beside_; }

 private:
  [[nodiscard]] GVOM_HD std::int32_t across(std::int32_t steps) const {
    return (steps * slope_ + 32768) >> 16;
  }

  std::int32_t x_, y_, n_xy_, at_, columns_, major_, slope_, columns_square_;
  std::int32_t along_at_, beside_;  // of the index, a column on
  bool by_x_;
};

}  // namespace gvom
