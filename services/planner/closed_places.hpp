// Places that the map does not forbid, but where the vehicle found no way.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/planner/map_view.hpp"

namespace gvom::planner {

/// Dead ends and ground that never showed. They are obstacles (HARD) in the map as long as there is another
/// way: where there is none, whoever asks clears them, and they are tried again.
class ClosedPlaces {
 public:
  static constexpr double kRadius_m = 2;

  explicit ClosedPlaces(int n_xy);

  void clear() { middles_m_.clear(); }
  [[nodiscard]] bool empty() const { return middles_m_.empty(); }
  /// The oldest of `kMost` is forgotten.
  void add(const Eigen::Vector2d& middle_m);
  /// The map with flags that hold these places. Borrows the map's arrays, and is valid until the next call.
  MapView close(const MapView& map);

 private:
  static constexpr std::size_t kMost = 8;

  std::vector<Eigen::Vector2d> middles_m_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace gvom::planner
