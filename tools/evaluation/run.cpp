#include "tools/evaluation/run.hpp"

#include <chrono>
#include <mutex>
#include <utility>

#include "tools/sim/parallel.hpp"

namespace gvom::evaluation {
namespace {

constexpr double kRoomAhead_m = 36.0;  // of path beyond the drive: what is judged lies ahead
constexpr double kLongestTurn_s = 0.1;

using Rows = tl::expected<std::vector<Row>, std::string>;

StageOptions stage_options(const Plan& plan, const DriveKind& kind) {
  StageOptions options;
  options.scene.seed = plan.seed;
  options.scene.speed_mps = kind.speed_mps;
  const int sweeps = plan.frames + plan.vehicle.mapper.window.buffer_size;
  options.scene.length_m = sweeps * kLongestTurn_s * kind.speed_mps + kRoomAhead_m;
  options.base_height_m = plan.vehicle.mapper.vehicle.base_height_m;
  options.resolution_m = plan.vehicle.mapper.map.resolution_xy_m;
  return options;
}

Rows run_scene(const Plan& plan, const std::string& scene) {
  std::vector<Row> rows;
  for (const DriveKind& kind : plan.drives) {
    const auto stage = Stage::set(scene, stage_options(plan, kind));
    if (!stage) return tl::unexpected(stage.error());
    for (const sim::Sensor sensor : kind.sensors) {
      Row row{scene, name_of(sensor), kind.name, {}};
      const DriveOptions options{sensor, kind.odometry_noise, plan.seed, plan.frames, plan.cache_directory};
      const auto figures = drive(**stage, plan.vehicle, options);
      if (!figures) return tl::unexpected(row.name() + ": " + figures.error());
      row.figures = *figures;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace

Rows run(const Plan& plan, const Progress& progress) {
  const auto count = static_cast<int>(plan.scenes.size());
  std::vector<Rows> results(plan.scenes.size());
  std::mutex one_at_a_time;
  int done = 0;
  sim::parallel_for(count, plan.threads, [&](int i) {
    const auto start = std::chrono::steady_clock::now();
    results[i] = run_scene(plan, plan.scenes[i]);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    progress(++done, count, plan.scenes[i], took.count());
  });
  std::vector<Row> rows;
  for (Rows& result : results) {
    if (!result) return result;
    for (Row& row : *result) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace gvom::evaluation
