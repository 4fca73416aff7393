// Worlds to drive in by waypoints: random ones, and the paper's tests.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/planner/map_view.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::driving {

struct CourseWorld {
  std::string name;
  sim::WorldData data;   ///< Its path: the start and the waypoints.
  planner::Pose2 start;  ///< Towards the first waypoint.
  std::vector<Eigen::Vector2d> waypoints_m;
};

/// Along x for `length_m` (40 m at least), waypoints 50 to 80 m apart where the length allows it. Each leg
/// has a cover (woods, rocks, bushes, grass), most have a ditch or a bank across the straight line with a way
/// around it, some a walker who crosses again and again, or dust. Nothing is nearer to start and waypoints
/// than 4 m. Usually there is a way: TruthPlanner knows.
CourseWorld make_campaign_world(std::uint64_t seed, double length_m = 300);

/// `test-1`, `test-2`: 260 and 240 m through scrub, trees and rocks on rough ground. `test-3`: up a step
/// of 1.5 m that is steep ahead and gentle at its left end; `test-4`: down it. The error names them.
tl::expected<CourseWorld, std::string> make_test_world(const std::string& name);

/// A world from files. Its path is the start and the waypoints; it is named after its folder. Errors are
/// those of `sim::read_world`, or say that the path has no waypoint.
tl::expected<CourseWorld, std::string> read_course_world(const std::string& folder);

}  // namespace gvom::driving
