// How the vehicle moves is told by poses alone.
#include <catch2/catch.hpp>

#include <cmath>

#include "services/planner/process/motion.hpp"

using namespace gvom;
using planner::MotionEstimate;
using planner::MotionNews;

namespace {

constexpr std::int64_t kStep_ns = 10'000'000;

StampedPose pose_at(std::int64_t stamp_ns, double x_m, double y_m, double yaw_rad) {
  return {stamp_ns,
          {{x_m, y_m, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))}};
}

/// Half a second along a circle from the origin, heading along +x.
MotionEstimate driven(double speed_mps, double curvature_per_m) {
  MotionEstimate motion(40);
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
  MotionEstimate motion(40);
  CHECK_FALSE(motion.state());
  for (int i = 0; i < 20; ++i) motion.take(pose_at(i * kStep_ns, 0.001 * (i % 2), 0, 0.01 * (i % 3)), 0);
  CHECK(motion.state()->curvature_per_m == 0);
  CHECK(std::abs(motion.state()->speed_mps) < 0.01);
}

TEST_CASE("heading goes on across the half turn") {
  MotionEstimate motion(40);
  for (int i = 0; i <= 20; ++i) {
    const double yaw = M_PI - 0.1 + 0.01 * i;
    motion.take(pose_at(i * kStep_ns, 0.02 * i * std::cos(yaw), 0.02 * i * std::sin(yaw), yaw), 0);
  }
  CHECK(motion.state()->curvature_per_m > 0);
  CHECK(motion.state()->curvature_per_m < 2);
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
