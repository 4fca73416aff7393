// Where the vehicle will be when what is commanded now reaches its wheels.
#pragma once

#include <vector>

#include "services/planner/follower.hpp"

namespace gvom::planner {

/// Remembers the commands that are on their way: the wheels do each `latency_s` after it was given.
class Prediction {
 public:
  explicit Prediction(const PlannerConfig& config);

  void forget();
  void add(const Command& command);
  /// Moves the vehicle by the commands on their way, within its limits, a period of `rate_hz` each.
  const Predicted& from(const Predicted& now);
  /// The poses after each period up to then.
  [[nodiscard]] const std::vector<Pose2>& way() const { return way_; }

 private:
  PlannerConfig config_;
  std::vector<Command> commands_;  ///< The oldest first; none yet is a stop.
  std::vector<Pose2> way_;
  Predicted predicted_;
};

}  // namespace gvom::planner
