// What walks or drives near the vehicle, told by what the map has said before.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "services/planner/map_view.hpp"

namespace gvom::planner {

/// Something hard now where `kBefore_ns` ago known ground was with nothing on it, for 0.4 m around: it has
/// come there. Noise of the odometry moves edges by less, and what stands had a shadow behind it before it
/// was seen to be hard. The room that it can reach until the vehicle is there is closed (HARD), so the
/// vehicle goes behind, slows down or waits.
class Movers {
 public:
  static constexpr std::int64_t kBefore_ns = 600'000'000;
  static constexpr double kNear_m = 12;      ///< Farther off, things come into sight.
  static constexpr double kWalks_mps = 1.4;  ///< How fast, if it goes on.
  static constexpr double kLeast_m = 1, kMost_m = 2.5;

  /// @param n_xy the largest map, columns along an edge
  explicit Movers(int n_xy);

  /// Forgets all: the map begins anew.
  void clear();
  /// Each cycle with a map. @param speed_mps of the vehicle
  void observe(const MapView& map, const Pose2& vehicle, double speed_mps);
  [[nodiscard]] bool empty() const { return movers_.empty(); }
  /// The map with flags that hold that room. Borrows the map's arrays, and is valid until the next call.
  MapView close(const MapView& map);

 private:
  struct Past {
    std::int64_t stamp_ns = 0;
    Cells cells;
    std::vector<std::uint8_t> is_open;  // 1: known ground with nothing on it
  };
  struct Mover {
    Eigen::Vector2d middle_m;
    double radius_m = 0;
    std::int64_t stamp_ns = 0;
  };
  static constexpr std::size_t kPasts = 16, kMost = 8;

  void remember(const MapView& map);
  [[nodiscard]] const Past* past(std::int64_t stamp_ns) const;
  static bool was_open(const Past& past, const Eigen::Vector2d& place_m);
  void add(const Eigen::Vector2d& place_m, double radius_m, std::int64_t stamp_ns);

  std::array<Past, kPasts> pasts_;
  std::size_t taken_ = 0;
  std::vector<Mover> movers_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace gvom::planner
