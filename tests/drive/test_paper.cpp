// The paper's tests 3 and 4, up and down a step of 1.5 m at 3 m/s: what the paper saw is seen.
#include <algorithm>
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

#include "services/common/config_file.hpp"
#include "tools/drive/cli/course_run.hpp"

using namespace gvom;
using namespace gvom::driving;

namespace {

constexpr double kStep_m = 25, kGentle_y_m = 6;  // the step is at x = 25 m, gentle from y = 6 m on

CourseRun drive_test(const std::string& name, const Onlooker& onlooker = {}) {
  const auto config =
      services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml", {"planner.speed_mps=3"});
  REQUIRE(config);
  CampaignOptions options;
  options.course = name;
  auto run = run_course(*config, options, onlooker);
  REQUIRE(run);
  return std::move(*run);
}

/// When ground was first seen in each column of 0.2 m.
class FirstSight {
 public:
  void look(const Seen& seen) {
    const double time_s = 1e-9 * static_cast<double>(seen.state.stamp_ns - sim::kStartNs);
    for (int y = 0; y < seen.grid.size[1]; ++y)
      for (int x = 0; x < seen.grid.size[0]; ++x)
        if (seen.layers.visibility[y * seen.grid.size[0] + x] ==
            static_cast<std::uint8_t>(Visibility::ground_seen))
          first_s_.emplace(std::pair(seen.grid.origin[0] + x, seen.grid.origin[1] + y), time_s);
  }
  /// Infinite: never.
  [[nodiscard]] double at(const Eigen::Vector2d& place_m) const {
    const auto found = first_s_.find(std::pair(static_cast<int>(std::floor(place_m.x() / 0.2)),
                                               static_cast<int>(std::floor(place_m.y() / 0.2))));
    return found == first_s_.end() ? HUGE_VAL : found->second;
  }

 private:
  std::map<std::pair<int, int>, double> first_s_;
};

void saw_what_the_paper_saw(const CourseRun& run) {
  INFO(text_of(run));
  CHECK(run.row.result.outcome == Outcome::arrived);
  const WayFigures &driven = run.figures.driven, &straight = run.figures.straight;
  CHECK(driven.mean_cost() < 0.5 * straight.mean_cost());
  CHECK(driven.least_distance_m() > 0.7);  // half of the vehicle's width
  CHECK(straight.least_distance_m() < 0.2);
  for (const DriveStep& step : run.row.result.log.steps)
    if (std::abs(step.place.x_m - kStep_m) < 0.2) CHECK(step.place.y_m > kGentle_y_m + 0.7);
}

}  // namespace

TEST_CASE("up the step by its gentle end", "[up]") {
  saw_what_the_paper_saw(drive_test("test-3"));
}

TEST_CASE("down the step by its gentle end, and not before the ground below was seen", "[down]") {
  FirstSight sight;
  const CourseRun run =
      drive_test("test-4", [&sight](const Seen& seen, const planner::Plan&) { sight.look(seen); });
  saw_what_the_paper_saw(run);
  const auto& steps = run.row.result.log.steps;
  const auto edge = std::find_if(steps.begin(), steps.end(),
                                 [](const DriveStep& step) { return step.place.x_m > kStep_m; });
  REQUIRE(edge != steps.end());
  constexpr double kFront_m = 0.76, kStops_m = 3;  // from 3 m/s, by 2.5 m/s2 after 0.4 s
  for (auto below = edge; below != steps.end() && below->place.x_m < kStep_m + 4; ++below) {
    const double seen_s = sight.at(below->place.place());
    const auto then = std::find_if(steps.begin(), steps.end(),
                                   [&](const DriveStep& step) { return step.time_s >= seen_s; });
    REQUIRE(then != steps.end());
    INFO(below->place.x_m << ", " << below->place.y_m << " m seen after " << seen_s << " s");
    CHECK((below->place.place() - then->place.place()).norm() > kStops_m + kFront_m);
  }
}
