// How near a way comes to obstacles, and what it costs, along its length.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/planner/costmap.hpp"

namespace gvom::driving {

struct WayFigures {
  static constexpr double kStep_m = 0.25;
  static constexpr double kFarthest_m = 10;  ///< Farther obstacles do not matter.

  std::vector<double> distance_m;  ///< From base_link to the nearest lethal column, at each step.
  std::vector<double> cost;        ///< Per metre, there; at most Costmap::kMostCost.

  [[nodiscard]] double length_m() const { return kStep_m * static_cast<double>(cost.size()); }
  [[nodiscard]] double least_distance_m() const;
  [[nodiscard]] double mean_distance_m() const;
  [[nodiscard]] double mean_cost() const;
};

/// Along straight pieces between two places or more, by the planner's costs of one map.
WayFigures measure_way(const planner::Costmap& costs, const std::vector<Eigen::Vector2d>& way_m);

}  // namespace gvom::driving
