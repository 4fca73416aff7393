// Where a vehicle has driven, or will, others can drive: but for the traffic there.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/evaluation/known_columns.hpp"

namespace gvom::evaluation {

/// The ground under base_link, point by point along the way, in odom.
using Way = std::vector<Eigen::Vector3d>;

/// Columns whose middle is within `half_width_m` of the way are drivable.
KnownColumns know_by_way(const Way& way_m, double half_width_m, double edge_m);

/// Nothing is known any more of columns within 1 m of a return that is 0.3 to 4 m above the nearest point of
/// the way: what stands there moves, since the vehicle has driven there too.
void forget_traffic(KnownColumns& known, const Way& way_m, const std::vector<Eigen::Vector3d>& returns_m);

}  // namespace gvom::evaluation
