// What was lethal where no lidar looks any more is lethal still.
#pragma once

#include <cstdint>
#include <vector>

#include "services/planner/carried_cells.hpp"

namespace gvom::planner {

/// The map forgets after a while (R17), and assumes ground around the vehicle (R9): one that stands beside a
/// ditch in its lidar's blind ring would drive into it. Within that and `kBeyond_m` a column that was
/// NEGATIVE or STEEP, or HARD from farther than that, stays so until ground is seen there without it.
class KeptPlaces {
 public:
  static constexpr double kBeyond_m = 1;

  /// @param n_xy the largest map, columns along an edge
  /// @param blind_m nearer than this lidars may see no ground
  KeptPlaces(int n_xy, double blind_m);

  /// Forgets all: the map begins anew.
  void clear() { lethal_.clear(); }
  /// Each cycle with a map. @return the map with flags that hold that. It borrows the map's arrays, and is
  /// valid until the next call.
  MapView keep(const MapView& map, const Eigen::Vector2d& vehicle_m);

 private:
  double near_m_;
  CarriedCells lethal_;  ///< ColumnFlags.
  std::vector<std::uint8_t> flags_;
};

}  // namespace gvom::planner
