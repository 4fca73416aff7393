// What was lethal where no lidar looks any more is lethal still.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/planner/carried_cells.hpp"

namespace gvom::planner {

/// The map forgets after a while (R17), and assumes ground around the vehicle (R9): one that stands beside a
/// ditch or a rock in its lidar's blind ring would drive into it. Within that and `kBeyond_m` a column that
/// was NEGATIVE or STEEP, or HARD from farther than that or for `kStood_ns`, stays so until ground is seen
/// there without it; what was HARD for that long alone at most for `kHolds_ns`, since somebody may have stood
/// there.
class KeptPlaces {
 public:
  static constexpr double kBeyond_m = 1;
  static constexpr std::int64_t kStood_ns = 2'000'000'000;
  static constexpr std::int64_t kHolds_ns = 30'000'000'000;

  /// @param n_xy the largest map, columns along an edge
  /// @param blind_m nearer than this lidars may see no ground
  KeptPlaces(int n_xy, double blind_m);

  /// Forgets all: the map begins anew.
  void clear() {
    lethal_.clear();
    stood_.clear();
    counted_ns_.reset();
  }
  /// Each cycle with a map. @return the map with flags that hold that. It borrows the map's arrays, and is
  /// valid until the next call.
  MapView keep(const MapView& map, const Eigen::Vector2d& vehicle_m);
  /// That map with nothing but holes kept: where what was HARD stays, nobody is seen to walk.
  [[nodiscard]] MapView holes(const MapView& map) const;

 private:
  static constexpr std::int64_t kTick_ns = 250'000'000;
  static constexpr std::int64_t kMostTicks = 2;  ///< Of one map: after a pause nobody knows what was before.
  static constexpr int kStood = kStood_ns / kTick_ns, kHolds = kHolds_ns / kTick_ns;

  void count(const MapView& map);

  double near_m_;
  CarriedCells lethal_;                     ///< ColumnFlags.
  CarriedCells stood_;                      ///< Ticks that it has been HARD; from kStood on that it is held.
  std::optional<std::int64_t> counted_ns_;  ///< The ticks up to then.
  std::vector<std::uint8_t> flags_, holes_;
};

}  // namespace gvom::planner
