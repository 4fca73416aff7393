// What happened on a drive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "services/planner/planner.hpp"
#include "tools/drive/mishap.hpp"

namespace gvom::driving {

/// One turn of the lidars. All of the vehicle is true, not from the odometry.
struct DriveStep {
  double time_s = 0;  ///< After the start of the drive: when the turn ends.
  Pose T_odom_base;
  planner::Pose2 place;
  double speed_mps = 0;
  double curvature_per_m = 0;
  std::optional<planner::Command> command;  ///< Given now; nothing: the driver was silent.
  double layers_age_s = 0;  ///< Of the newest return in the layers, when the command takes effect.
  double nearest_m = 0;     ///< From the outline to a true obstacle (TrueObstacles).
};

struct DriveLog {
  std::vector<DriveStep> steps;
  std::optional<Mishap> mishap;
  bool is_done = false;  ///< The driver said so.
  double driven_m = 0;
  double nearest_m = std::numeric_limits<double>::infinity();  ///< Of all steps.
  double nearest_sum_m = 0;
  int bushes_driven_through = 0;
  int grass_driven_through = 0;

  void add(const DriveStep& step) {
    nearest_m = std::min(nearest_m, step.nearest_m);
    nearest_sum_m += step.nearest_m;
    steps.push_back(step);
  }
  [[nodiscard]] double seconds() const { return steps.empty() ? 0.0 : steps.back().time_s; }
  [[nodiscard]] double mean_nearest_m() const {
    return steps.empty() ? 0.0 : nearest_sum_m / static_cast<double>(steps.size());
  }
};

}  // namespace gvom::driving
