#include "tools/drive/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "tools/drive/cover.hpp"
#include "tools/drive/land.hpp"
#include "tools/sim/world_files.hpp"

namespace gvom::driving {
namespace {

constexpr double kLeg_m = 62;
constexpr double kWander_m = 14;      // of a waypoint from the one before, sideways
constexpr double kFarthest_m = 25;    // of a waypoint from the x axis
constexpr double kFreeAround_m = 4;   // of start and waypoints
constexpr double kFreeByDitch_m = 3;  // beyond its sides and ends
constexpr double kTestStep_m = 25;    // of the way, to the step of test-3 and test-4

/// The start at the origin, then the waypoints.
std::vector<Eigen::Vector2d> draw_line(sim::Random& random, double length_m) {
  const int legs = std::max(1, static_cast<int>(std::lround(length_m / kLeg_m)));
  std::vector<Eigen::Vector2d> line{{0, 0}};
  for (int leg = 1; leg <= legs; ++leg) {
    const double y = line.back().y() + random.between(-kWander_m, kWander_m);
    line.emplace_back(sim::quantised(leg * length_m / legs),
                      sim::quantised(std::clamp(y, -kFarthest_m, kFarthest_m)));
  }
  return line;
}

sim::Course course_of(const std::vector<Eigen::Vector2d>& line) {
  sim::Course course{line, line};
  course.trail_m.insert(course.trail_m.begin(), line.front() - Eigen::Vector2d(sim::kAround, 0));
  course.trail_m.emplace_back(line.back() + Eigen::Vector2d(sim::kAround, 0));
  return course;
}

std::vector<CourseLeg> legs_of(const std::vector<Eigen::Vector2d>& line) {
  std::vector<CourseLeg> legs;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) legs.push_back({line[i], line[i + 1]});
  return legs;
}

/// Across the line, one end within reach.
sim::Ditch draw_ditch(sim::Random& random, const CourseLeg& leg) {
  sim::Ditch ditch;
  ditch.middle_m = leg.at(random.between(0.4, 0.65)) + Eigen::Vector2d(0, random.between(-4, 4));
  ditch.turned_rad = random.between(-0.4, 0.4);
  ditch.width_m = random.between(1.0, 2.2);
  ditch.depth_m = random.between(0.7, 1.3);
  ditch.half_length_m = random.between(5, 10);
  return ditch;
}

Bank draw_bank(sim::Random& random, const CourseLeg& leg) {
  const Eigen::Vector2d middle = leg.at(random.between(0.4, 0.6));
  Bank bank;
  bank.upper_x_m = middle.x();
  bank.height_m = random.between(0.8, 1.5);
  bank.goes_up = random.between(0, 1) < 0.5;
  bank.side = random.between(0, 1) < 0.5 ? -1 : 1;
  bank.gentle_y_m = middle.y() + bank.side * random.between(2, 6);
  return bank;
}

Land draw_land(sim::Random& random, std::uint64_t seed, const sim::Course& course,
               const std::vector<CourseLeg>& legs) {
  const double steepest = random.between(0.08, 0.32);
  Land land{sim::Relief(sim::derive(seed, 0x1A4D), course, {steepest, 16, 60}), {}, {}};
  for (const CourseLeg& leg : legs) {
    const double kind = random.between(0, 1);
    if (kind < 0.4) land.ditches.push_back(draw_ditch(random, leg));
    if (kind >= 0.4 && kind < 0.65) land.banks.push_back(draw_bank(random, leg));
  }
  return land;
}

/// Things stand neither at waypoints nor in the ways around.
void keep_free(sim::Planter& planter, const std::vector<Eigen::Vector2d>& line, const Land& land) {
  for (const Eigen::Vector2d& point : line) planter.keep_free(point, kFreeAround_m);
  for (const sim::Ditch& ditch : land.ditches) {
    const Eigen::Vector2d along(-std::sin(ditch.turned_rad), std::cos(ditch.turned_rad));
    const double half_m = ditch.half_length_m + kFreeByDitch_m;
    for (double at = -half_m; at <= half_m; at += 1)
      planter.keep_free(ditch.middle_m + at * along, 0.5 * ditch.width_m + kFreeByDitch_m);
  }
  for (const Bank& bank : land.banks)
    for (double beyond = 0; beyond <= 2 * Bank::kTwist_m; beyond += 2)
      for (double x = -10; x <= 10; x += 2)
        planter.keep_free({bank.upper_x_m + x, bank.gentle_y_m + bank.side * beyond}, 2);
}

CourseWorld finish(std::string name, sim::WorldData data, const std::vector<Eigen::Vector2d>& line) {
  const Eigen::Vector2d ahead = line[1] - line[0];
  data.name = name;
  return {std::move(name),
          std::move(data),
          {line[0].x(), line[0].y(), std::atan2(ahead.y(), ahead.x())},
          {line.begin() + 1, line.end()}};
}

sim::WorldData paint(const Land& land, const sim::Course& course) {
  return sim::paint_world("", course, [&](double x, double y) { return land.at(x, y); });
}

/// One kind of cover for the leg, and a little of all.
void cover_leg(sim::WorldData& world, sim::Planter& planter, sim::Random& random, const CourseLeg& leg) {
  if (random.between(0, 1) < 0.35) add_walker(planter, random, leg);
  if (random.between(0, 1) < 0.25) raise_dust(world, planter, random, leg);
  switch (random.count(0, 3)) {
    case 0:
      plant(planter, random, leg, {30, 0, 90});
      break;
    case 1:
      plant(planter, random, leg, {0, 40, 0});
      break;
    case 2:
      plant(planter, random, leg, {0, 0, 30});
      break;
    default:
      sow_grass(planter, random, leg);
  }
  plant(planter, random, leg, {250, 300, 200});
}

/// Rough ground with trees, rocks and scrub everywhere.
CourseWorld make_scrubland(const char* name, std::uint64_t seed, double length_m) {
  sim::Random random(sim::derive(seed, 0x5C4B));
  const std::vector<Eigen::Vector2d> line = draw_line(random, length_m);
  const sim::Course course = course_of(line);
  const Land land{sim::Relief(seed, course, {0.2, 14, 50, 0.08}), {}, {}};
  sim::WorldData world = paint(land, course);
  sim::Planter planter(world, course);
  keep_free(planter, line, land);
  for (const CourseLeg& leg : legs_of(line)) plant(planter, random, leg, {70, 110, 45});
  return finish(name, std::move(world), line);
}

/// The step crosses the whole world; gentle from 8 m to the left on, seen along the way.
CourseWorld make_step(const char* name, bool goes_up) {
  const std::vector<Eigen::Vector2d> line{{0, 0}, {2 * kTestStep_m, 0}};
  const sim::Course course = course_of(line);
  Bank bank;
  bank.upper_x_m = kTestStep_m;
  bank.goes_up = goes_up;
  bank.gentle_y_m = 6;
  const Land land{sim::Relief(3, course, {0.02, 20, 60}), {}, {bank}};
  return finish(name, paint(land, course), line);
}

}  // namespace

CourseWorld make_campaign_world(std::uint64_t seed, double length_m) {
  sim::Random random(sim::derive(seed, 0xCA4));
  const std::vector<Eigen::Vector2d> line = draw_line(random, length_m);
  const std::vector<CourseLeg> legs = legs_of(line);
  const sim::Course course = course_of(line);
  const Land land = draw_land(random, seed, course, legs);
  sim::WorldData world = paint(land, course);
  sim::Planter planter(world, course);
  keep_free(planter, line, land);
  for (const CourseLeg& leg : legs) cover_leg(world, planter, random, leg);
  return finish("campaign-" + std::to_string(seed), std::move(world), line);
}

tl::expected<CourseWorld, std::string> make_test_world(const std::string& name) {
  if (name == "test-1") return make_scrubland("test-1", 1, 260);
  if (name == "test-2") return make_scrubland("test-2", 2, 240);
  if (name == "test-3") return make_step("test-3", true);
  if (name == "test-4") return make_step("test-4", false);
  return tl::unexpected(name + ": no such test; there are test-1, test-2, test-3 and test-4");
}

tl::expected<CourseWorld, std::string> read_course_world(const std::string& folder) {
  auto data = sim::read_world(folder);
  if (!data) return tl::unexpected(data.error());
  if (data->path_m.size() < 2) return tl::unexpected(folder + ": its path is a start without a waypoint");
  const std::vector<Eigen::Vector2d> line = data->path_m;
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return finish((path.has_filename() ? path : path.parent_path()).filename(), std::move(*data), line);
}

}  // namespace gvom::driving
