#include "tools/evaluation/stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/evaluation/sweep_cache.hpp"

namespace gvom::evaluation {
namespace {

/// The world without what lets rays through, what moves, and what rays do not end on.
sim::WorldData solid_part(sim::WorldData data) {
  for (sim::Object& object : data.objects) {
    const auto is_porous = [](const sim::Body& body) { return std::isfinite(body.hits_per_m); };
    object.bodies.erase(std::remove_if(object.bodies.begin(), object.bodies.end(), is_porous),
                        object.bodies.end());
    if (object.kind == sim::Kind::walker) object.bodies.clear();
  }
  for (sim::Surface& surface : data.ground.surface)
    if (surface == sim::Surface::mirror || surface == sim::Surface::dark) surface = sim::Surface::ground;
  data.rain_hits_per_m = 0.0;
  return data;
}

/// Points of the way of base_link, `kPathStep_m` apart.
std::vector<Eigen::Vector2d> path_of(const sim::Trajectory& trajectory, double speed_mps) {
  std::vector<Eigen::Vector2d> path_m;
  const auto steps = static_cast<int>(trajectory.seconds() * speed_mps / kPathStep_m);
  for (int i = 0; i <= steps; ++i)
    path_m.emplace_back(trajectory.at(i * kPathStep_m / speed_mps).translation_m.head<2>());
  return path_m;
}

}  // namespace

tl::expected<std::unique_ptr<Stage>, std::string> Stage::set(const std::string& scene,
                                                             const StageOptions& options) {
  auto data = sim::build_scene(scene, options.scene);
  if (!data) return tl::unexpected(data.error());
  return std::unique_ptr<Stage>(new Stage(std::move(*data), options));
}

Stage::Stage(sim::WorldData data, const StageOptions& options)
    : speed_mps_(options.scene.speed_mps),
      world_key_(key_of(data)),
      world_(data),
      solid_(solid_part(std::move(data))),
      trajectory_(world_.terrain(), world_.data().path_m, {speed_mps_, options.base_height_m}),
      truth_(sim::sample_truth(world_, {options.resolution_m, trajectory_.seconds(), 1})),
      facts_(find_facts(world_.data(), truth_, path_of(trajectory_, speed_mps_))) {}

Sight Stage::sight() const {
  return [this](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    const Eigen::Vector3d way = to_m - from_m;
    const double way_m = way.norm();
    const double range_m = solid_.cast({from_m, way / way_m}, {}, way_m, 0).range_m;
    return range_m <= way_m ? range_m : std::numeric_limits<double>::infinity();
  };
}

}  // namespace gvom::evaluation
