#include "tools/evaluation/run.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>

#include "tools/evaluation/picture.hpp"
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

/// Draws the scene as the drive's map shows it.
tl::expected<void, std::string> draw(const Plan& plan, const Stage& stage, const InstructiveFrame& kept,
                                     const Row& row) {
  if (kept.empty()) return {};
  const double to_hole_m =
      stage.facts().holes.empty() ? 0.0 : stage.facts().holes.front().rim_driven_m - kept.frame().driven_m;
  char title[160];
  std::snprintf(title, sizeof title,
                to_hole_m > 0.0 ? "%s, %.1f m driven, %.1f m before the rim" : "%s, %.1f m driven",
                row.name().c_str(), kept.frame().driven_m, to_hole_m);
  return draw_scene(stage.facts(), stage.sight(), kept.frame(), title)
      .write_png(plan.pictures_directory + "/" + row.scene + ".png");
}

Rows run_scene(const Plan& plan, const std::string& scene) {
  std::vector<Row> rows;
  for (const DriveKind& kind : plan.drives) {
    const auto stage = Stage::set(scene, stage_options(plan, kind));
    if (!stage) return tl::unexpected(stage.error());
    for (const sim::Sensor sensor : kind.sensors) {
      Row row{scene, name_of(sensor), kind.name, {}};
      const DriveOptions options{sensor, kind.odometry_noise, plan.seed, plan.frames, plan.cache_directory};
      InstructiveFrame kept((*stage)->facts(), plan.frames);
      const bool drawn = !plan.pictures_directory.empty() && rows.empty();  // one picture a scene
      const auto figures = drive(**stage, plan.vehicle, options,
                                 drawn ? Watch([&](const Frame& frame) { kept.see(frame); }) : Watch());
      if (!figures) return tl::unexpected(row.name() + ": " + figures.error());
      if (const auto done = draw(plan, **stage, kept, row); !done) return tl::unexpected(done.error());
      row.figures = *figures;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace

Rows run(const Plan& plan, const Progress& progress) {
  if (!plan.pictures_directory.empty()) {
    std::error_code error;
    std::filesystem::create_directories(plan.pictures_directory, error);
    if (error) return tl::unexpected(plan.pictures_directory + ": " + error.message());
  }
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
