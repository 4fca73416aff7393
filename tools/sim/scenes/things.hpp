// The things that scenes are furnished with. Lengths in metres, odom frame; a foot is a point on the ground.
#pragma once

#include <Eigen/Core>

#include "tools/sim/noise.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::sim {

struct TreeShape {
  double trunk_radius_m;
  double crown_bottom_m;  ///< Above the foot.
  double crown_radius_m;
  double height_m;
};

/// A tree as its trunk makes it: thicker ones are higher, and their crowns wider. The crown begins at 2.5 m
/// or higher.
TreeShape draw_tree(Random& random, double trunk_radius_m);

Object make_tree(Random& random, const Eigen::Vector3d& foot, const TreeShape& shape);
Object make_bush(Random& random, const Eigen::Vector3d& foot, double radius_m, double height_m);
Object make_rock(Random& random, const Eigen::Vector3d& foot, double radius_m, double height_m);

/// An empty patch of grass around `middle`; tussocks make it one.
Object make_grass(const Eigen::Vector3d& middle, double radius_m);
void add_tussock(Object& grass, const Eigen::Vector3d& foot, double radius_m, double height_m);

/// `size_m`: length along its own x, thickness, height.
Object make_wall(const Eigen::Vector3d& foot, const Eigen::Vector3d& size_m, double yaw_rad);

/// A car of 4.4 x 1.8 x 1.45 m along x; its floor is 0.2 m above the ground.
Object make_car(const Eigen::Vector3d& foot);

/// A post of a lamp, 5 m high: for a planner the trunk of a tree.
Object make_post(const Eigen::Vector3d& foot, double radius_m);

/// A branch with twigs from `root` to `tip`, its lowest point `height_m` above `foot`, the ground below.
struct BranchShape {
  Eigen::Vector3d foot;
  Eigen::Vector2d root_m;
  Eigen::Vector2d tip_m;
  double radius_m;
  double height_m;
};
Object make_branch(const BranchShape& shape);

/// Walks along the track; its first point is where it stands at first.
Object make_walker(const Eigen::Vector3d& foot, std::vector<TrackPoint> track);

Object make_dust(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, double hits_per_m);

}  // namespace gvom::sim
