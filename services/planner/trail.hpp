// The way that the vehicle came, and how it backs along it.
#pragma once

#include <vector>

#include "services/common/planner_config.hpp"
#include "services/planner/map_view.hpp"
#include "services/planner/planner.hpp"

namespace gvom::planner {

/// The last `kMost` driven poses, at least `kStep_m` apart. What is backed over is forgotten.
class Trail {
 public:
  static constexpr double kStep_m = 0.2;
  static constexpr std::size_t kMost = 100;

  Trail() { poses_.reserve(kMost); }

  void clear() { poses_.clear(); }
  /// @param pose of the vehicle in odom, now
  void add(const Pose2& pose, bool backs);
  [[nodiscard]] double length_m() const;
  /// The curvature that leads backwards along it. It is not empty.
  [[nodiscard]] double curvature_back(const Pose2& pose) const;

 private:
  static constexpr double kLookAhead_m = 1.2;

  std::vector<Pose2> poses_;
};

}  // namespace gvom::planner
