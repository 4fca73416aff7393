// Small worlds for the simulator's tests.
#pragma once

#include <limits>
#include <utility>

#include "tools/sim/world.hpp"

namespace gvom::test {

/// Level ground at 0 m, nodes 0.1 m apart, from -30 to 90 m along x and -30 to 30 m along y; a path of 60 m
/// along x.
inline sim::WorldData level_world() {
  sim::WorldData world;
  world.name = "level";
  world.ground.min_x_m = -30.0;
  world.ground.min_y_m = -30.0;
  world.ground.nodes_x = 1201;
  world.ground.nodes_y = 601;
  world.ground.height_m.assign(1201 * 601, 0.0F);
  world.ground.surface.assign(1201 * 601, sim::Surface::ground);
  world.path_m = {{0.0, 0.0}, {60.0, 0.0}};
  return world;
}

/// Sets what the ground is, and its height, between two corners, those included.
inline void paint(sim::WorldData& world, Eigen::Vector2d low, Eigen::Vector2d high, sim::Surface surface,
                  double height_m) {
  sim::GroundMap& ground = world.ground;
  for (int iy = 0; iy < ground.nodes_y; ++iy)
    for (int ix = 0; ix < ground.nodes_x; ++ix) {
      const double x = ground.min_x_m + ix * ground.resolution_m;
      const double y = ground.min_y_m + iy * ground.resolution_m;
      constexpr double kRounding = 1e-6;
      if (x < low.x() - kRounding || y < low.y() - kRounding || x > high.x() + kRounding ||
          y > high.y() + kRounding)
        continue;
      const std::size_t at = static_cast<std::size_t>(iy) * ground.nodes_x + ix;
      ground.surface[at] = surface;
      ground.height_m[at] = static_cast<float>(height_m);
    }
}

inline sim::Body ball(const Eigen::Vector3d& centre, double radius_m) {
  sim::Body body;
  body.centre = centre;
  body.size.setConstant(radius_m);
  return body;
}

inline sim::Body box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_edges, double yaw_rad = 0.0) {
  sim::Body body;
  body.shape = sim::Body::Shape::box;
  body.centre = centre;
  body.size = half_edges;
  body.yaw_rad = yaw_rad;
  return body;
}

/// An upright capsule from below the ground to `top_m`.
inline sim::Body post(double x_m, double y_m, double radius_m, double top_m) {
  sim::Body body;
  body.shape = sim::Body::Shape::capsule;
  body.centre = {x_m, y_m, -0.5};
  body.size = {0.0, 0.0, top_m + 0.5 - radius_m};
  body.radius_m = radius_m;
  return body;
}

inline void add(sim::WorldData& world, sim::Kind kind, sim::Body body, double height_m = 1.0,
                double hits_per_m = std::numeric_limits<double>::infinity()) {
  body.hits_per_m = hits_per_m;
  sim::Object object;
  object.kind = kind;
  object.position_m = {body.centre.x(), body.centre.y(), 0.0};
  object.height_m = height_m;
  object.bodies = {body};
  world.objects.push_back(std::move(object));
}

}  // namespace gvom::test
