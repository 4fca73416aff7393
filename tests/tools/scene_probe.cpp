#include "tests/tools/scene_probe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace gvom::test {
namespace {

using namespace gvom::sim;

constexpr double kStep = 0.2;
constexpr double kBeside = 1.0;
constexpr double kOverhead = 2.0;
constexpr double kDegrees = 57.29577951308232;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_solid(const Body& body) {
  return std::isinf(body.hits_per_m);
}

bool contains(const Body& body, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d from = point_m - body.centre;
  if (body.shape == Body::Shape::capsule) {
    const double at = std::clamp(from.dot(body.size) / body.size.squaredNorm(), 0.0, 1.0);
    return (from - at * body.size).norm() <= body.radius_m;
  }
  const double cosine = std::cos(body.yaw_rad), sine = std::sin(body.yaw_rad);
  const Eigen::Vector3d own(cosine * from.x() + sine * from.y(), cosine * from.y() - sine * from.x(),
                            from.z());
  const Eigen::Array3d part = own.array() / body.size.array();
  return body.shape == Body::Shape::box ? part.abs().maxCoeff() <= 1.0 : part.matrix().squaredNorm() <= 1.0;
}

/// Lowest and highest z.
Eigen::Vector2d extent(const Body& body) {
  const double z = body.centre.z();
  if (body.shape != Body::Shape::capsule) return {z - body.size.z(), z + body.size.z()};
  const double end = z + body.size.z();
  return {std::min(z, end) - body.radius_m, std::max(z, end) + body.radius_m};
}

/// Calls `visit(place, direction)` along the polyline.
void along(const std::vector<Eigen::Vector2d>& line_m,
           const std::function<void(const Eigen::Vector2d&, const Eigen::Vector2d&)>& visit) {
  for (std::size_t i = 0; i + 1 < line_m.size(); ++i) {
    const Eigen::Vector2d leg = line_m[i + 1] - line_m[i];
    for (double at = 0.0; at < leg.norm(); at += kStep)
      visit(line_m[i] + at * leg.normalized(), leg.normalized());
  }
}

Surface surface_at(const GroundMap& ground, const Eigen::Vector2d& place_m) {
  const auto node = [&](double value, double least, int count) {
    return std::clamp(static_cast<int>(std::lround((value - least) / ground.resolution_m)), 0, count - 1);
  };
  const int ix = node(place_m.x(), ground.min_x_m, ground.nodes_x);
  const int iy = node(place_m.y(), ground.min_y_m, ground.nodes_y);
  return ground.surface[static_cast<std::size_t>(iy) * ground.nodes_x + ix];
}

double steepness(const GroundMap& ground, const Eigen::Vector2d& place_m) {
  constexpr double kReach = 0.6;
  const double x = place_m.x(), y = place_m.y();
  return std::hypot(height_at(ground, x + kReach, y) - height_at(ground, x - kReach, y),
                    height_at(ground, x, y + kReach) - height_at(ground, x, y - kReach)) /
         (2.0 * kReach);
}

bool near_hole(const GroundMap& ground, const Eigen::Vector2d& place_m) {
  for (double dy = -1.2; dy <= 1.2; dy += 0.1)
    for (double dx = -1.2; dx <= 1.2; dx += 0.1)
      if (surface_at(ground, place_m + Eigen::Vector2d(dx, dy)) == Surface::hole) return true;
  return false;
}

std::vector<const Body*> solid_bodies_near(const WorldData& world) {
  std::vector<const Body*> bodies;
  for (const Object& object : world.objects)
    for (const Body& body : object.bodies) {
      const double reach = body.size.head<2>().norm() + body.radius_m + kBeside;
      if (object.kind != Kind::walker && is_solid(body) &&
          distance_to(world.path_m, body.centre.head<2>()) < reach)
        bodies.push_back(&body);
    }
  return bodies;
}

}  // namespace

void Fingerprint::add(const void* bytes, std::size_t count) {
  const auto* begin = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ begin[i]) * 1099511628211ULL;
}

std::uint64_t Fingerprint::of(const WorldData& world) {
  const GroundMap& ground = world.ground;
  for (const double value : {ground.resolution_m, ground.min_x_m, ground.min_y_m, world.rain_hits_per_m})
    add(value);
  add(ground.height_m.data(), ground.height_m.size() * sizeof(float));
  add(ground.surface.data(), ground.surface.size());
  for (const Eigen::Vector2d& corner : world.path_m) add(corner.data(), 2 * sizeof(double));
  for (const Object& object : world.objects) {
    add(object.position_m.data(), 3 * sizeof(double));
    for (const double value : {static_cast<double>(object.kind), object.radius_m, object.height_m})
      add(value);
    for (const TrackPoint& point : object.track)
      for (const double value : {point.time_s, point.x_m, point.y_m}) add(value);
    for (const Body& body : object.bodies) {
      add(body.centre.data(), 3 * sizeof(double));
      add(body.size.data(), 3 * sizeof(double));
      for (const double value : {static_cast<double>(body.shape), body.radius_m, body.yaw_rad,
                                 body.hits_per_m, static_cast<double>(body.reflectivity)})
        add(value);
    }
  }
  return value_;
}

double ScenePath::distance_m(const Eigen::Vector2d& place_m) const {
  return distance_to(world_.path_m, place_m);
}

std::string ScenePath::first_obstacle() const {
  const std::vector<const Body*> bodies = solid_bodies_near(world_);
  std::string found;
  along(world_.path_m, [&](const Eigen::Vector2d& place, const Eigen::Vector2d& ahead) {
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    for (double beside = -kBeside; beside <= kBeside; beside += kStep)
      for (double up = 0.05; up < kOverhead; up += 0.1) {
        const Eigen::Vector2d at = place + beside * left;
        const Eigen::Vector3d point(at.x(), at.y(), height_at(world_.ground, at.x(), at.y()) + up);
        const auto holds = [&](const Body* body) { return contains(*body, point); };
        if (found.empty() && std::any_of(bodies.begin(), bodies.end(), holds))
          found =
              "x " + std::to_string(at.x()) + " y " + std::to_string(at.y()) + " up " + std::to_string(up);
      }
  });
  return found;
}

double ScenePath::steepest_deg() const {
  double steepest = 0.0;
  along(world_.path_m, [&](const Eigen::Vector2d& place, const Eigen::Vector2d&) {
    if (!near_hole(world_.ground, place)) steepest = std::max(steepest, steepness(world_.ground, place));
  });
  return kDegrees * std::atan(steepest);
}

double ScenePath::share_of(Surface surface) const {
  int places = 0, found = 0;
  along(world_.path_m, [&](const Eigen::Vector2d& place, const Eigen::Vector2d&) {
    ++places;
    found += surface_at(world_.ground, place) == surface;
  });
  return static_cast<double>(found) / places;
}

double steepest_deg(const GroundMap& ground) {
  double steepest = 0.0;
  for (int iy = 6; iy < ground.nodes_y - 6; iy += 3)
    for (int ix = 6; ix < ground.nodes_x - 6; ix += 3)
      steepest = std::max(steepest, steepness(ground, {ground.min_x_m + ix * ground.resolution_m,
                                                       ground.min_y_m + iy * ground.resolution_m}));
  return kDegrees * std::atan(steepest);
}

double shallowest_hole_m(const GroundMap& ground) {
  const auto reach = static_cast<int>(3.0 / ground.resolution_m);
  double shallowest = kInfinity;
  for (int iy = 0; iy < ground.nodes_y; iy += 5)
    for (int ix = 0; ix < ground.nodes_x; ++ix) {
      const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * ground.nodes_x + x; };
      if (ground.surface[at(ix, iy)] != Surface::hole) continue;
      float rim = ground.height_m[at(ix, iy)];
      for (int step = -reach; step <= reach; ++step) {
        rim = std::max(rim, ground.height_m[at(std::clamp(ix + step, 0, ground.nodes_x - 1), iy)]);
        rim = std::max(rim, ground.height_m[at(ix, std::clamp(iy + step, 0, ground.nodes_y - 1))]);
      }
      shallowest = std::min(shallowest, static_cast<double>(rim) - ground.height_m[at(ix, iy)]);
    }
  return shallowest;
}

double top_m(const Object& object) {
  double top = -kInfinity;
  for (const Body& body : object.bodies) top = std::max(top, extent(body).y());
  return top;
}

double bottom_m(const Object& object) {
  double bottom = kInfinity;
  for (const Body& body : object.bodies) bottom = std::min(bottom, extent(body).x());
  return bottom;
}

double lowest_leaf_m(const Object& object) {
  double lowest = kInfinity;
  for (const Body& body : object.bodies)
    if (!is_solid(body)) lowest = std::min(lowest, extent(body).x() - object.position_m.z());
  return lowest;
}

}  // namespace gvom::test
