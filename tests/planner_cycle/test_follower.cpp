// The follower, the prediction and what else is small in a cycle.
#include <catch2/catch.hpp>

#include "services/planner/course.hpp"
#include "services/planner/follower.hpp"
#include "services/planner/prediction.hpp"
#include "tests/planner_cycle/small_vehicle.hpp"

namespace gvom::test {
namespace {

using planner::Command;
using planner::PlannerConfig;
using planner::Pose2;
using planner::Predicted;
using planner::TrajectoryPoint;

// An arc from the origin along x, points 0.25 m apart, at a constant speed.
std::vector<TrajectoryPoint> arc(double curvature_per_m, double speed_mps) {
  std::vector<TrajectoryPoint> points(400);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = 0.25 * static_cast<double>(i), turned = s * curvature_per_m;
    points[i].pose = curvature_per_m == 0 ? Pose2{s, 0, 0}
                                          : Pose2{std::sin(turned) / curvature_per_m,
                                                  (1 - std::cos(turned)) / curvature_per_m, turned};
    points[i].curvature_per_m = curvature_per_m;
    points[i].speed_mps = speed_mps;
  }
  return points;
}

TEST_CASE("On its trajectory it commands the trajectory's curvature") {
  for (const double curvature : {0.0, 0.1, -0.3}) {
    const double command = planner::follow({}, {{0, 0, 0}, 2, curvature}, arc(curvature, 2));
    CHECK(command == Approx(curvature).margin(1e-6));
  }
}

TEST_CASE("It steers back to its trajectory, as hard as it can and no harder") {
  const PlannerConfig config;  // 1 / (m s), so 0.1 / m in a period; at most 0.7 / m
  CHECK(planner::follow(config, {{0, 0.5, 0}, 3, 0}, arc(0, 3)) < -0.02);
  CHECK(planner::follow(config, {{0, -0.5, 0}, 3, 0}, arc(0, 3)) > 0.02);
  CHECK(planner::follow(config, {{0, 2, 0.8}, 3, 0}, arc(0, 3)) == Approx(-0.1));
  CHECK(planner::follow(config, {{0, 2, 0.8}, 3, -0.65}, arc(0, 3)) >= -0.7);
}

TEST_CASE("In a loop an error of 0.4 m dies within 12 m and does not swing") {
  PlannerConfig config;
  config.vehicle.latency_s = 0;
  for (const double speed_mps : {1.0, 4.5}) {
    SmallVehicle vehicle(config.vehicle, {0, 0.4, 0});
    vehicle.drive({speed_mps, 0}, 4);  // gets up to speed, straight on
    const double begin_m = vehicle.pose().x_m;
    const std::vector<TrajectoryPoint> line = arc(0, speed_mps);
    double lowest_m = 1;
    while (vehicle.pose().x_m < begin_m + 20) {
      const auto at = static_cast<std::ptrdiff_t>(vehicle.pose().x_m / 0.25);
      const std::vector<TrajectoryPoint> ahead(line.begin() + at, line.end());
      const Predicted now{vehicle.pose(), vehicle.speed_mps(), vehicle.curvature_per_m()};
      vehicle.drive({speed_mps, planner::follow(config, now, ahead)}, 0.1);
      lowest_m = std::min(lowest_m, vehicle.pose().y_m);
      if (vehicle.pose().x_m > begin_m + 12) CHECK(std::abs(vehicle.pose().y_m) < 0.05);
    }
    CHECK(lowest_m > -0.08);
  }
}

TEST_CASE("The prediction is where the vehicle is when the command arrives") {
  const PlannerConfig config;  // 0.3 s
  planner::Prediction prediction(config);
  SmallVehicle vehicle(config.vehicle, {1, 2, 0.5});
  for (int i = 0; i < 40; ++i) {
    const Command command{0.1 * i, 0.3 * std::sin(0.2 * i)};
    const Predicted predicted =
        prediction.from({vehicle.pose(), vehicle.speed_mps(), vehicle.curvature_per_m()});
    SmallVehicle copy = vehicle;
    copy.drive(command, 0.3);  // what it commands only begins to matter then
    CHECK((predicted.pose.place() - copy.pose().place()).norm() < 0.05);
    CHECK(predicted.speed_mps == Approx(copy.speed_mps()).margin(0.02));
    CHECK(predicted.curvature_per_m == Approx(copy.curvature_per_m()).margin(0.02));
    prediction.add(command);
    vehicle.drive(command, 0.1);
  }
}

/// Progress, told ten times a second what holds until something else does.
class Watched {
 public:
  bool update(double to_s, double cost, double distance_m) {
    bool gives_up = false;
    for (; now_s_ < to_s - 0.05; now_s_ += 0.1) gives_up |= tell();
    now_s_ = to_s, cost_ = cost, distance_m_ = distance_m;
    return tell() || gives_up;
  }
  /// The clock is set.
  void leap(double by_s) { clock_s_ += by_s; }

 private:
  bool tell() {
    return progress_.update(static_cast<std::int64_t>((now_s_ + clock_s_) * 1e9), cost_, distance_m_);
  }

  planner::Progress progress_{10};
  double now_s_ = 0, clock_s_ = 0, cost_ = 1e3, distance_m_ = 1e3;
};

TEST_CASE("It gives up after its time without a metre of progress") {
  Watched progress;
  CHECK_FALSE(progress.update(0, 50, 40));
  CHECK_FALSE(progress.update(9, 49, 40));   // by 1 of cost: begins anew
  CHECK_FALSE(progress.update(18, 49, 39));  // by 1 m of distance
  CHECK_FALSE(progress.update(27.9, 48.1, 38.1));
  CHECK(progress.update(28.2, 48.1, 38.1));
}

TEST_CASE("A clock that leaps is no time that passed") {
  Watched progress;
  CHECK_FALSE(progress.update(0, 50, 40));
  progress.leap(3600);
  CHECK_FALSE(progress.update(4, 50, 40));
  progress.leap(-1800);
  CHECK_FALSE(progress.update(8.5, 50, 40));  // a second for the leap ahead
  CHECK(progress.update(11, 50, 40));
}

TEST_CASE("A way that turns out to be none is no progress, and to come nearer on the next one is") {
  Watched progress;
  progress.update(0, 20, 40);
  CHECK_FALSE(progress.update(5, 90, 40));
  CHECK_FALSE(progress.update(9, 88, 41));   // nearer on the new way
  CHECK_FALSE(progress.update(18, 88, 41));  // 9 s after that
  CHECK(progress.update(19.5, 88, 41));
  const auto at = [](double seconds) { return static_cast<std::int64_t>(seconds * 1e9); };
  // To and fro for ever: five times as long without the best of all.
  planner::Progress swings(10);
  bool gives_up = false;
  double second = 0;
  for (; second < 100 && !gives_up; ++second)
    gives_up = swings.update(at(second),
                             static_cast<int>(second) % 8 < 4 ? 30 - static_cast<int>(second) % 8 : 60, 40);
  CHECK(gives_up);
  CHECK(second > 50);
  CHECK(second < 60);
}

}  // namespace
}  // namespace gvom::test
