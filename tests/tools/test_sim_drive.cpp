// The vehicle follows its path at its speed, leans with the ground, and bridges what is a hole.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/sim_worlds.hpp"
#include "tools/sim/sweep_simulator.hpp"
#include "tools/sim/trajectory.hpp"

using namespace gvom::sim;
using namespace gvom::test;

namespace {

Trajectory drive(const World& world, double speed_mps, double base_height_m = 0.0) {
  return {world.terrain(), world.data().path_m, {speed_mps, base_height_m}};
}

double pitch(const gvom::Pose& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return -std::asin(forward.z());
}

double heading(const gvom::Pose& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

}  // namespace

TEST_CASE("it starts at the path's first point and is as far as its speed says, at its height") {
  const World world(level_world());
  const Trajectory trajectory = drive(world, 4.0, 0.3);
  CHECK(trajectory.seconds() == Approx(15.0));
  CHECK((trajectory.at(0.0).translation_m - Eigen::Vector3d(0.0, 0.0, 0.3)).norm() < 1e-9);
  CHECK((trajectory.at(2.5).translation_m - Eigen::Vector3d(10.0, 0.0, 0.3)).norm() < 1e-9);
  CHECK((trajectory.at(-0.05).translation_m - Eigen::Vector3d(-0.2, 0.0, 0.3)).norm() < 1e-9);
  CHECK((trajectory.at(15.1).translation_m - Eigen::Vector3d(60.4, 0.0, 0.3)).norm() < 1e-9);
}

TEST_CASE("corners are rounded: the heading never jumps, the speed never changes") {
  WorldData data = level_world();
  data.path_m = {{0.0, 0.0}, {20.0, 0.0}, {20.0, 0.0}, {20.0, 20.0}};
  const World world(std::move(data));
  const Trajectory trajectory = drive(world, 5.0);
  CHECK(trajectory.seconds() == Approx(8.0).margin(0.3));
  for (double time = 0.0; time < trajectory.seconds(); time += 0.01) {
    const gvom::Pose here = trajectory.at(time), next = trajectory.at(time + 0.01);
    CHECK((next.translation_m - here.translation_m).norm() == Approx(0.05).epsilon(0.01));
    CHECK(std::abs(heading(next) - heading(here)) < 0.04);
  }
  CHECK(heading(trajectory.at(1.0)) == Approx(0.0).margin(1e-9));
  CHECK(heading(trajectory.at(7.0)) == Approx(1.5707963));
  CHECK(trajectory.at(7.0).translation_m.x() == Approx(20.0));
}

TEST_CASE("it pitches and rolls with the ground, and does not shake on ripples") {
  WorldData data = level_world();
  for (int iy = 0; iy < data.ground.nodes_y; ++iy)
    for (int ix = 0; ix < data.ground.nodes_x; ++ix) {
      const double ripple = ix % 2 == 0 ? 0.03 : -0.03;
      data.ground.height_m[static_cast<std::size_t>(iy) * data.ground.nodes_x + ix] =
          static_cast<float>(0.01 * ix + 0.02 * iy + ripple);
    }
  const World world(std::move(data));
  const Trajectory trajectory = drive(world, 5.0);
  for (double time = 1.0; time < 5.0; time += 0.01) {
    CHECK(pitch(trajectory.at(time)) == Approx(-std::atan(0.1)).margin(0.012));
    const Eigen::Vector3d left = trajectory.at(time).rotation * Eigen::Vector3d::UnitY();
    CHECK(left.z() == Approx(std::sin(std::atan(0.2))).margin(0.012));
  }
}

TEST_CASE("over a ditch between two levels it goes straight from rim to rim") {
  WorldData data = level_world();
  paint(data, {20.0, -30.0}, {90.0, 30.0}, Surface::ground, 0.2);
  paint(data, {20.0, -30.0}, {22.0, 30.0}, Surface::hole, -1.0);
  const World world(std::move(data));
  const Trajectory trajectory = drive(world, 1.0);
  double before = trajectory.at(18.0).translation_m.z();
  CHECK(before == Approx(0.0).margin(1e-6));
  for (double time = 18.0; time < 24.0; time += 0.01) {
    const double height = trajectory.at(time).translation_m.z();
    CHECK(height >= before - 1e-9);
    CHECK(height < before + 0.005);
    before = height;
  }
  CHECK(before == Approx(0.2));
}

TEST_CASE("odometry noise has the deviation that was asked for") {
  WorldData data = level_world();
  data.path_m = {{0.0, 0.0}, {20.0, 0.0}};
  const World world(std::move(data));
  const Trajectory trajectory = drive(world, 0.2);
  const OdometrySpan span{kStartNs, kStartNs, kStartNs + 100'000'000'000, 100};
  double sum = 0.0;
  const auto poses = make_odometry(trajectory, span, {0.05, 0.002}, 1);
  const auto exact = make_odometry(trajectory, span, {}, 1);
  double turned = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    sum += (poses[i].T_odom_base.translation_m - exact[i].T_odom_base.translation_m).squaredNorm();
    turned += std::pow(poses[i].T_odom_base.rotation.angularDistance(exact[i].T_odom_base.rotation), 2);
  }
  const auto count = static_cast<double>(poses.size());
  CHECK(std::sqrt(sum / count / 3.0) == Approx(0.05).epsilon(0.2));
  CHECK(std::sqrt(turned / count / 3.0) == Approx(0.002).epsilon(0.2));
}
