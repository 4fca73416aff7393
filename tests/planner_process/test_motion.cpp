// How the vehicle moves is told by poses alone.
#include <catch2/catch.hpp>

#include <cmath>

#include "services/planner/process/motion.hpp"

using namespace gvom;
using planner::MotionEstimate;
using planner::MotionNews;

namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
const services::OdometryConfig kOdometry;  // 40 m/s

StampedPose pose_at(std::int64_t stamp_ns, double x_m, double y_m, double yaw_rad) {
  return {stamp_ns,
          {{x_m, y_m, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))}};
}

/// Half a second along a circle from the origin, heading along +x.
MotionEstimate driven(double speed_mps, double curvature_per_m) {
  MotionEstimate motion(kOdometry);
  for (int i = 0; i <= 50; ++i) {
    const double way_m = speed_mps * 0.01 * i, yaw = way_m * curvature_per_m;
    const double x_m = curvature_per_m == 0 ? way_m : std::sin(yaw) / curvature_per_m;
    const double y_m = curvature_per_m == 0 ? 0 : (1 - std::cos(yaw)) / curvature_per_m;
    REQUIRE(motion.take(pose_at(i * kStep_ns, x_m, y_m, yaw), 0) == MotionNews::used);
  }
  return motion;
}

}  // namespace

TEST_CASE("speed and curvature of a circle, forwards and backwards") {
  for (const double speed_mps : {4.5, 1.0, -1.5})
    for (const double curvature_per_m : {0.0, 0.4, -0.4}) {
      const auto state = driven(speed_mps, curvature_per_m).state();
      REQUIRE(state);
      CHECK(state->stamp_ns == 50 * kStep_ns);
      CHECK(state->speed_mps == Approx(speed_mps).epsilon(0.01));  // the chord of 0.15 s
      CHECK(state->curvature_per_m == Approx(curvature_per_m).margin(1e-6).epsilon(0.01));
    }
}

TEST_CASE("at a stand there is no curvature, whatever noise says") {
  MotionEstimate motion(kOdometry);
  CHECK_FALSE(motion.state());
  for (int i = 0; i < 20; ++i) motion.take(pose_at(i * kStep_ns, 0.001 * (i % 2), 0, 0.01 * (i % 3)), 0);
  CHECK(motion.state()->curvature_per_m == 0);
  CHECK(std::abs(motion.state()->speed_mps) < 0.01);
}

TEST_CASE("heading goes on across the half turn") {
  MotionEstimate motion(kOdometry);
  for (int i = 0; i <= 20; ++i) {
    const double yaw = M_PI - 0.1 + 0.01 * i;
    motion.take(pose_at(i * kStep_ns, 0.02 * i * std::cos(yaw), 0.02 * i * std::sin(yaw), yaw), 0);
  }
  CHECK(motion.state()->curvature_per_m > 0);
  CHECK(motion.state()->curvature_per_m < 2);
}

TEST_CASE("it goes on as it did: so it is placed between two poses") {
  for (const double curvature_per_m : {0.0, 0.4}) {
    const MotionEstimate motion = driven(4.5, curvature_per_m);
    const auto later = motion.state_after(200'000'000);
    REQUIRE(later);
    CHECK(later->stamp_ns == 70 * kStep_ns);
    const double yaw = 4.5 * 0.7 * curvature_per_m;
    const double x_m = curvature_per_m == 0 ? 4.5 * 0.7 : std::sin(yaw) / curvature_per_m;
    const double y_m = curvature_per_m == 0 ? 0 : (1 - std::cos(yaw)) / curvature_per_m;
    CHECK(later->T_odom_base.translation_m.x() == Approx(x_m).margin(0.02));
    CHECK(later->T_odom_base.translation_m.y() == Approx(y_m).margin(0.02));
    CHECK(planner::flat(later->T_odom_base).yaw_rad == Approx(yaw).margin(0.01));
    CHECK(later->speed_mps == motion.state()->speed_mps);
  }
  CHECK_FALSE(MotionEstimate(kOdometry).state_after(1));
}

TEST_CASE("a heading that leaps is a jump, as it is to those who map") {
  MotionEstimate motion = driven(4, 0);
  CHECK(motion.take(pose_at(51 * kStep_ns, 2.04, 0, 0.1), 0) == MotionNews::used);
  CHECK(motion.take(pose_at(52 * kStep_ns, 2.08, 0, 0.8), 0) == MotionNews::jump);  // 40 degrees in 10 ms
  CHECK(motion.state()->curvature_per_m == 0);
}

TEST_CASE("after one pose of tomorrow, or a clock that was set back, it goes on") {
  MotionEstimate motion = driven(4, 0);
  CHECK(motion.take(pose_at(360'000 * kStep_ns, 2.04, 0, 0), 0) == MotionNews::used);
  int refused = 0;
  while (motion.take(pose_at((51 + refused) * kStep_ns, 2.04, 0, 0), 0) == MotionNews::backwards) ++refused;
  CHECK(refused == 7);
  CHECK(motion.state()->stamp_ns == (51 + refused) * kStep_ns);
  CHECK(motion.take(pose_at((52 + refused) * kStep_ns, 2.08, 0, 0), 0) == MotionNews::used);
}

TEST_CASE("a stamp that is repeated, however often, is no clock that was set back") {
  MotionEstimate motion = driven(4, 0);
  for (int i = 0; i < 20; ++i)
    CHECK(motion.take(pose_at(50 * kStep_ns, 2, 0, 0), 0) == MotionNews::backwards);
  CHECK(motion.state()->speed_mps == Approx(4));
  CHECK(motion.take(pose_at(51 * kStep_ns, 2.04, 0, 0), 0) == MotionNews::used);
}

TEST_CASE("a jump and a new epoch begin anew; what is no pose is not used") {
  MotionEstimate motion = driven(4, 0);
  CHECK(motion.take(pose_at(50 * kStep_ns, 2, 0, 0), 0) == MotionNews::backwards);
  CHECK(motion.take(pose_at(51 * kStep_ns, NAN, 0, 0), 0) == MotionNews::not_a_pose);
  CHECK(motion.take(pose_at(51 * kStep_ns, 2.45, 0, 0), 0) == MotionNews::used);  // 0.45 m: too little
  CHECK(motion.take(pose_at(52 * kStep_ns, 3.45, 0, 0), 0) == MotionNews::jump);  // 1 m in 10 ms
  CHECK(motion.state()->speed_mps == 0);
  CHECK(motion.take(pose_at(0, 0, 0, 0), 1) == MotionNews::anew);
  CHECK(motion.epoch() == 1);
  CHECK(motion.take(pose_at(60 * kStep_ns, 0, 0, 0), 0) == MotionNews::old_epoch);
}
