#include "tools/drive/cli/course_run.hpp"

#include <fstream>
#include <optional>

#include "tools/drive/pictures/course_figure.hpp"

namespace gvom::driving {
namespace {

constexpr double kStart_s = 1;  // until then it is what is known at the start

/// Everything that the world has of ground.
CourseMap map_of(const CourseWorld& world, double cell_m) {
  const sim::GroundMap& ground = world.data.ground;
  const double edge_m = (std::max(ground.nodes_x, ground.nodes_y) - 1) * ground.resolution_m;
  return {{ground.min_x_m, ground.min_y_m}, edge_m, cell_m};
}

std::vector<Eigen::Vector2d> driven_way(const DriveLog& log) {
  std::vector<Eigen::Vector2d> way;
  for (const DriveStep& step : log.steps) way.push_back(step.place.place());
  return way;
}

tl::expected<void, std::string> write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return tl::unexpected(path + ": cannot be written");
  return {};
}

}  // namespace

tl::expected<CourseRun, std::string> run_course(const services::VehicleConfig& config,
                                                const CampaignOptions& options) {
  const std::uint64_t seed = options.first_seed;
  const auto world = world_of(options, seed);
  if (!world) return tl::unexpected(world.error());
  Witness witness(options.folder, *world, seed, Strips::all);
  const Onlooker witness_looks = witness.onlooker();
  CourseMap map = map_of(*world, config.mapper.map.resolution_xy_m);
  std::optional<CourseMap> at_start;
  auto result = run_session(
      *world, config, session_options(options, seed), [&](const Seen& seen, const planner::Plan& plan) {
        witness_looks(seen, plan);
        map.add(seen);
        const double time_s = 1e-9 * static_cast<double>(seen.state.stamp_ns - sim::kStartNs);
        if (!at_start && time_s >= kStart_s) at_start = map;
      });
  if (!result) return tl::unexpected(result.error());
  CourseRun run{{world->name, seed, std::move(*result)}, ""};
  std::vector<Eigen::Vector2d> straight{world->start.place()};
  straight.insert(straight.end(), world->waypoints_m.begin(), world->waypoints_m.end());
  const CourseFigures figures =
      compare_ways(map.view(), config.planner, driven_way(run.row.result.log), straight);
  run.figures = text_of(figures);
  const std::string words = line_of(run.row), stem = options.folder + "/" + world->name;
  return witness.finish(config.planner.vehicle, run.row.result.outcome, words)
      .and_then([&] { return draw_course(words, map.view(), figures).write_png(stem + ".png"); })
      .and_then([&] {
        return draw_slopes(words, at_start.value_or(map).view(), map.view(), figures)
            .write_png(stem + "-slopes.png");
      })
      .and_then([&] { return write_text(stem + ".json", json_of(figures)); })
      .map([&] { return std::move(run); });
}

}  // namespace gvom::driving
