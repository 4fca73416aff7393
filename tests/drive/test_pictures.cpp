// What pictures of drives are made of: which frames, which map, which figures along a way.
#include <cmath>
#include <filesystem>
#include <limits>

#include <catch2/catch.hpp>

#include "tests/tools/temporary_folder.hpp"
#include "tools/drive/pictures/course_figure.hpp"
#include "tools/drive/pictures/film.hpp"
#include "tools/drive/pictures/strip.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

constexpr int kColumns = 8;
constexpr double kCell_m = 0.5;

/// Layers of 4 x 4 m, all of one value.
struct Layers {
  Layers() : storage(map()) {}

  static MapConfig map() {
    MapConfig config;
    config.size_xy = kColumns;
    config.resolution_xy_m = kCell_m;
    return config;
  }
  Seen seen(double time_s, double x_m, float height_m, Visibility visibility, std::uint8_t flags = 0) {
    const LayerArrays& arrays = storage.arrays();
    const std::size_t n = kColumns * kColumns;
    std::fill_n(arrays.height, n, height_m);
    for (float* zero : {arrays.slope_x, arrays.slope_y, arrays.slope, arrays.roughness})
      std::fill_n(zero, n, 0.0F);
    std::fill_n(arrays.clearance, n, std::numeric_limits<float>::infinity());
    std::fill_n(arrays.flags, n, flags);
    std::fill_n(arrays.visibility, n, static_cast<std::uint8_t>(visibility));
    grid = grid_around(map(), {x_m, 0, 0});
    grid.origin[0] = static_cast<int>(std::floor(x_m / kCell_m)) - kColumns / 2;
    grid.origin[1] = -kColumns / 2;
    planner::State state;
    state.stamp_ns = sim::kStartNs + std::llround(time_s * 1e9);
    state.T_odom_base.translation_m = {x_m, 0, 0};
    return {arrays, grid, state.stamp_ns, 0.1, state};
  }

  mapping::LayerStorage storage;
  Grid grid;
};

std::vector<double> times_of(const std::vector<const Frame*>& frames) {
  std::vector<double> times;
  for (const Frame* frame : frames) times.push_back(frame->time_s);
  return times;
}

Film film_of(double seconds) {
  Layers layers;
  Film film;
  for (int turn = 0; turn <= std::lround(seconds * 10); ++turn)
    film.add(layers.seen(0.1 * turn, 0.1 * turn, 0, Visibility::ground_seen), {});
  return film;
}

/// Level ground from (0, 0) to (20, 20), one column of it HARD.
struct Field {
  explicit Field(const Eigen::Vector2d& hard_m) : map({0, 0}, 20, kCell_m) {
    Layers layers;
    for (double x = 0; x < 20; x += 2)
      for (double y = 0; y < 20; y += 2) {
        Seen seen = layers.seen(0, x, 0, Visibility::ground_seen);
        layers.grid.origin[1] = static_cast<int>(y / kCell_m);
        const int column_x = static_cast<int>(std::floor(hard_m.x() / kCell_m)) - layers.grid.origin[0];
        const int column_y = static_cast<int>(std::floor(hard_m.y() / kCell_m)) - layers.grid.origin[1];
        if (column_x >= 0 && column_y >= 0 && column_x < kColumns && column_y < kColumns)
          layers.storage.arrays().flags[column_y * kColumns + column_x] = kHard;
        map.add(seen);
      }
  }
  CourseMap map;
};

}  // namespace

TEST_CASE(
    "a film of a short drive has all its frames, of a long one evenly spaced ones, and always the end") {
  CHECK(times_of(film_of(2.0).pick(3)) == std::vector<double>{0, 1, 2});
  const Film film = film_of(100.3);
  const std::vector<double> times = times_of(film.pick(6));
  REQUIRE(times.size() == 6);
  CHECK(times.front() == 0);
  CHECK(times.back() == Approx(100.3));
  for (std::size_t i = 1; i < times.size(); ++i) CHECK(std::abs(times[i] - times[i - 1] - 20) < 8.1);
  CHECK(film.way().size() == 1004);
  CHECK(film.pick(6).back()->driven == 1004);
}

TEST_CASE("of a drive that failed half of the frames are of its last seconds") {
  const std::vector<double> times = times_of(film_of(60).pick_end(8));
  REQUIRE(times.size() == 8);
  CHECK(times[7] == Approx(60));
  for (int i = 4; i < 7; ++i) {
    INFO(times[i]);
    CHECK(times[i + 1] - times[i] > 0.05);
    CHECK(times[i] > 60 - Film::kLastFrames * Film::kBetweenLast_s - 0.05);
  }
  CHECK(times[0] == 0);
  CHECK(times[3] < times[4]);
}

TEST_CASE("the map of a drive holds the newest that was seen, and nothing that is only remembered") {
  Layers layers;
  CourseMap map({0, -5}, 10, kCell_m);
  const auto height_at = [&](double x_m, double y_m) {
    const planner::MapView view = map.view();
    return view.height[view.cells().index_of(x_m, y_m)];
  };
  map.add(layers.seen(0, 2, 1, Visibility::ground_seen));
  CHECK(height_at(2, 0) == 1);
  CHECK(std::isnan(height_at(7, 0)));  // 4 x 4 m around the vehicle are seen
  map.add(layers.seen(1, 3, 2, Visibility::ground_seen));
  CHECK(height_at(3, 0) == 2);
  CHECK(height_at(0.2, 0) == 1);  // seen before only
  map.add(layers.seen(2, 3, 9, Visibility::remembered));
  map.add(layers.seen(2, 3, 9, Visibility::free_only));
  map.add(layers.seen(2, 3, 9, Visibility::ground_assumed));
  CHECK(height_at(3, 0) == 2);
}

TEST_CASE("a column of that map has the flags of more than half of its looks") {
  Layers layers;
  CourseMap map({0, -5}, 10, kCell_m);
  const auto look = [&](std::uint8_t flags) {
    const Seen seen = layers.seen(0, 2, 1, Visibility::ground_seen);
    std::fill_n(layers.storage.arrays().flags, kColumns * kColumns, flags);
    map.add(seen);
    return map.view().flags[map.view().cells().index_of(2, 0)];
  };
  CHECK(look(0) == 0);
  CHECK(look(kHard) == 0);
  CHECK(look(kHard | kSteep) == kHard);
  CHECK(look(kSteep) == 0);
  CHECK(look(kHard | kSteep) == (kHard | kSteep));
}

TEST_CASE("distance and cost along a way are those of the map below it") {
  const Field field({10.1, 5.1});  // its column's middle is at (10.25, 5.25)
  const planner::PlannerConfig config;
  const CourseFigures figures = compare_ways(JudgedMap(field.map.view(), config), {{2, 11}, {18, 11}},
                                             {{2, 5.25}, {10, 5.25}, {18, 5.25}});
  CHECK(figures.driven.length_m() == Approx(16));
  CHECK(figures.straight.length_m() == Approx(16));
  CHECK(figures.straight.least_distance_m() == Approx(0).margin(1e-6));
  CHECK(figures.driven.least_distance_m() == Approx(6.0).margin(0.01));  // column middles, 12 columns off
  CHECK(figures.driven.mean_cost() == Approx(1));
  CHECK(figures.straight.mean_cost() > 3);
  const int middle = static_cast<int>(8.25 / WayFigures::kStep_m);
  CHECK(figures.straight.cost[middle] == planner::Costmap::kMostCost);
}

TEST_CASE("a frame has the vehicle in its middle, and outlines of what is true where it is") {
  const Film film = film_of(0);  // at (0, 0), heading +x; 10 pixels a metre
  const std::vector<Edge> wall{{{5, 5}, {5, 9}}};
  const std::vector<std::vector<Edge>> walkers{{{{-5, -9}, {-5, -5}}}};
  const auto canvas = draw_strip(film.pick(8), {film.way(), {}, wall, walkers}, {}, {"world", "arrived"});
  const auto at = [&](double x_m, double y_m) {
    return canvas.at(kFirstLeft_px + static_cast<int>(200 + 10 * x_m),
                     kFirstTop_px + static_cast<int>(200 - 10 * y_m));
  };
  CHECK(at(-0.4, 0) == kVehicleColour);
  CHECK(at(0.2, 0.4) == kVehicleColour);
  CHECK(at(-1.2, 0) != kVehicleColour);
  CHECK(at(0.2, 1.0) != kVehicleColour);
  CHECK(at(10, 7) == snapshot::kUnknown);  // the map is 4 m wide
  CHECK(at(5, 7) != snapshot::kUnknown);
  CHECK(at(-5, -7) != snapshot::kUnknown);
}

TEST_CASE("a strip has its frames in rows of four, and is a file") {
  const TemporaryFolder folder;
  const Film film = film_of(10);
  const auto canvas = draw_strip(film.pick(6), {film.way(), {{5, 0}}, {}, {}}, {}, {"world", "arrived"});
  CHECK(canvas.width() > kFramesInRow * kFrame_px);
  CHECK(canvas.width() < (kFramesInRow + 1) * kFrame_px);
  CHECK(canvas.height() > 2 * kFrame_px);
  CHECK(canvas.height() < 3 * kFrame_px);
  REQUIRE(canvas.write_png(folder.path() + "/strip.png"));
  CHECK(std::filesystem::file_size(folder.path() + "/strip.png") > 1000);
}
