#include "tests/oracle/sight_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace gvom::oracle {

SightLine::SightLine(const ColumnAt& column, const ColumnAt& vehicle)
    : column_(column),
      dx_(vehicle.x - column.x),
      dy_(vehicle.y - column.y),
      length_(std::max(std::abs(dx_), std::abs(dy_))) {}

double SightLine::step_m(double resolution_m) const {
  const double squares = static_cast<double>(dx_) * dx_ + static_cast<double>(dy_) * dy_;
  return resolution_m * std::sqrt(squares) / length_;
}

ColumnAt SightLine::beside(int step, int side) const {
  const bool main_is_x = std::abs(dx_) >= std::abs(dy_);
  const int main = main_is_x ? dx_ : dy_, other = main_is_x ? dy_ : dx_;
  const double slope = length_ == 0 ? 0 : std::trunc(65536.0 * other / length_);
  const int along = main > 0 ? step : -step;
  const int across = static_cast<int>(std::floor((step * slope + 32768) / 65536)) + side;
  return main_is_x ? ColumnAt{column_.x + along, column_.y + across}
                   : ColumnAt{column_.x + across, column_.y + along};
}

}  // namespace gvom::oracle
