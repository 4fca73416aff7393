// Whether there is a way, and how long it takes, for who knows the world.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/sim/ground_truth.hpp"

namespace gvom::driving {

/// Metres in odom.
struct TrueWay {
  double seconds = 0;
  double length_m = 0;
  std::vector<Eigen::Vector2d> points_m;  ///< Middles of columns, from the first to the last waypoint.
};

struct TrueDriver {
  double width_m = 1.4;
  double speed_mps = 4.5;         ///< On level ground.
  double goal_tolerance_m = 1.5;  ///< A waypoint is reached within it.
};

/// Dijkstra over the truth's columns, 8-connected. What cannot be driven on is grown by half the width;
/// bushes cannot, walkers and grass can. Speed falls to half on the steepest ground that can be driven on;
/// turning costs nothing.
class TruthPlanner {
 public:
  /// The truth must outlive it.
  TruthPlanner(const sim::GroundTruth& truth, const TrueDriver& driver);

  /// From `start_m` to each waypoint in turn; nothing where there is no way.
  [[nodiscard]] std::optional<TrueWay> plan(const Eigen::Vector2d& start_m,
                                            const std::vector<Eigen::Vector2d>& waypoints_m) const;

  /// Whether the middle of the vehicle may be here, whatever its heading.
  [[nodiscard]] bool is_free(const Eigen::Vector2d& point_m) const;

 private:
  struct Leg {
    int end;  ///< The column within the tolerance that is reached first.
    double seconds;
    std::vector<int> columns;  ///< Without the first.
  };

  [[nodiscard]] std::optional<Leg> plan_leg(int from, const Eigen::Vector2d& to_m) const;
  [[nodiscard]] int column_at(const Eigen::Vector2d& point_m) const;
  [[nodiscard]] Eigen::Vector2d middle_of(int column) const;

  const sim::GroundTruth& truth_;
  TrueDriver driver_;
  std::vector<std::uint8_t> is_free_;
  std::vector<float> seconds_per_m_;
};

}  // namespace gvom::driving
