// What the map said over a whole drive, so that ways can be compared on it that were not driven.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/planner/map_view.hpp"
#include "tools/drive/loop.hpp"

namespace gvom::driving {

/// Of each column the newest that was seen of it, and the flags that it had in more than half of all looks:
/// single ones have specks on level ground. What only was remembered is not taken.
class CourseMap {
 public:
  /// A square from `low_m` on, `edge_m` wide, of columns of `cell_m`.
  CourseMap(const Eigen::Vector2d& low_m, double edge_m, double cell_m);

  void add(const Seen& seen);

  /// Valid until the next `add`.
  [[nodiscard]] planner::MapView view() const;

 private:
  /// How often a column was seen, and with which flag.
  struct Looks {
    std::uint16_t all = 0;
    std::array<std::uint16_t, 8> with{};

    std::uint8_t add(std::uint8_t flags);
  };

  Grid grid_;
  std::vector<float> height_, slope_, roughness_, clearance_;
  std::vector<std::uint8_t> flags_, visibility_;
  std::vector<Looks> looks_;
};

}  // namespace gvom::driving
