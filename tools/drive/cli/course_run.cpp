#include "tools/drive/cli/course_run.hpp"

#include <cstdio>
#include <fstream>
#include <optional>

#include "tools/drive/pictures/course_map.hpp"

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

/// Of a number that may not be there.
std::string json_number(const std::optional<double>& value) {
  char text[32] = "null";
  if (value) std::snprintf(text, sizeof text, "%.2f", *value);
  return text;
}

struct Maps {
  CourseMap whole;
  std::optional<CourseMap> at_start;

  void add(const Seen& seen) {
    whole.add(seen);
    const double time_s = 1e-9 * static_cast<double>(seen.state.stamp_ns - sim::kStartNs);
    if (!at_start && time_s >= kStart_s) at_start = whole;
  }
};

tl::expected<void, std::string> write_pictures(const CourseRun& run, const std::string& stem,
                                               const JudgedMap& whole, const JudgedMap& at_start) {
  const PictureWords words{run.row.world, story_of(run.row)};
  return draw_course(words, whole, run.figures)
      .write_png(stem + ".png")
      .and_then(
          [&] { return draw_slopes(words, at_start, whole, run.figures).write_png(stem + "-slopes.png"); })
      .and_then([&] { return write_text(stem + ".json", json_of(run)); });
}

}  // namespace

tl::expected<CourseRun, std::string> run_course(const services::VehicleConfig& config,
                                                const CampaignOptions& options, const Onlooker& onlooker) {
  const std::uint64_t seed = options.first_seed;
  const auto world = world_of(options, seed);
  if (!world) return tl::unexpected(world.error());
  Witness witness({options.keeping.folder, Strips::all, options.keeping.mcap}, *world, seed, config);
  const Onlooker witness_looks = witness.onlooker();
  Maps maps{map_of(*world, config.mapper.map.resolution_xy_m), {}};
  auto result = run_session(*world, config, session_options(options, seed),
                            [&](const Seen& seen, const planner::Plan& plan) {
                              if (witness_looks) witness_looks(seen, plan);
                              if (onlooker) onlooker(seen, plan);
                              maps.add(seen);
                            });
  if (!result) return tl::unexpected(result.error());
  std::vector<Eigen::Vector2d> straight{world->start.place()};
  straight.insert(straight.end(), world->waypoints_m.begin(), world->waypoints_m.end());
  const JudgedMap whole(maps.whole.view(), config.planner);
  CourseRun run{{world->name, seed, std::move(*result)}, {}};
  run.figures = compare_ways(whole, driven_way(run.row.result.log), straight);
  if (options.keeping.folder.empty()) return run;
  const CourseMap& start = maps.at_start ? *maps.at_start : maps.whole;
  const JudgedMap at_start(start.view(), config.planner);
  return witness.finish(run.row.result.outcome, story_of(run.row))
      .and_then(
          [&] { return write_pictures(run, options.keeping.folder + "/" + world->name, whole, at_start); })
      .map([&] { return std::move(run); });
}

std::string text_of(const CourseRun& run) {
  return run.row.world + ": " + story_of(run.row) + "\n" + text_of(run.figures);
}

std::string json_of(const CourseRun& run) {
  const SessionResult& result = run.row.result;
  std::optional<double> way_s, way_m;
  if (result.way) way_s = result.way->seconds, way_m = result.way->length_m;
  return "{\"course\": \"" + run.row.world + "\", \"seed\": " + std::to_string(run.row.seed) +
         ", \"outcome\": \"" + words_of(result.outcome) +
         "\", \"seconds\": " + json_number(result.log.seconds()) +
         ", \"truth_planner\": {\"seconds\": " + json_number(way_s) +
         ", \"length_m\": " + json_number(way_m) +
         "}, \"true_obstacles\": {\"least_distance_m\": " + json_number(result.log.nearest_m) +
         ", \"mean_distance_m\": " + json_number(result.log.mean_nearest_m()) + "}, " + json_of(run.figures) +
         "}\n";
}

}  // namespace gvom::driving
