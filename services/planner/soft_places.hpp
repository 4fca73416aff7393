// What was soft from afar is soft when it is near.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/planner/carried_cells.hpp"

namespace gvom::planner {

/// Within the blind ring of a lidar few rays come through grass and bushes, and what was SOFT all the way up
/// becomes HARD beside the vehicle. A column that was SOFT from farther than that ring stays so within that.
/// So does an open one next to it: odometry's noise moves edges by a column. One that was HARD, or has such a
/// neighbour, and one that was never seen from afar, is HARD.
class SoftPlaces {
 public:
  static constexpr std::uint8_t kSure = 3;  ///< In so many maps, one after the other.

  /// @param n_xy the largest map, columns along an edge
  /// @param near_m so far the ring reaches
  SoftPlaces(int n_xy, double near_m);

  /// Forgets all: the map begins anew.
  void clear() {
    states_.clear();
    counted_ns_.reset();
  }
  /// Each cycle with a map, which may be that of the cycle before. @return the map with flags that hold that.
  /// It borrows the map's arrays, and is valid until the next call.
  /// @param map what to soften: as it was seen, and what is kept
  /// @param seen the same as it was seen
  MapView soften(const MapView& map, const MapView& seen, const Eigen::Vector2d& vehicle_m);

 private:
  static constexpr std::uint8_t kWasHard = 255;

  [[nodiscard]] bool was_soft(int cell) const;
  void count(const MapView& map, const Eigen::Vector2d& vehicle_m);

  double near_m_;
  CarriedCells states_;                     ///< In how many maps it was SOFT, or kWasHard.
  std::optional<std::int64_t> counted_ns_;  ///< The stamp of the newest of them.
  std::vector<std::uint8_t> flags_;
};

}  // namespace gvom::planner
