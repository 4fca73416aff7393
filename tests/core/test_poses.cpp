// Poses between odometry (R3), and what they do to a sweep that was measured on the move.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"

namespace gvom::test {
namespace {

using Add = OdometryBuffer::Add;

Eigen::Quaterniond yaw(double rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ()));
}

Pose pose(double x_m, double yaw_rad = 0) {
  return {{x_m, 0, 0}, yaw(yaw_rad)};
}

TEST_CASE("Between two poses translation is linear and rotation a slerp") {
  OdometryBuffer odometry;
  REQUIRE(odometry.add({100, {{1, 2, 3}, yaw(0)}}) == Add::added);
  REQUIRE(odometry.add({300, {{3, 2, -1}, yaw(1.5)}}) == Add::added);
  const auto halfway = odometry.at(200);
  REQUIRE(halfway);
  CHECK(halfway->translation_m.isApprox(Eigen::Vector3d(2, 2, 1)));
  CHECK(halfway->rotation.angularDistance(yaw(0.75)) < 1e-12);
  const auto late = odometry.at(250);
  REQUIRE(late);
  CHECK(late->translation_m.isApprox(Eigen::Vector3d(2.5, 2, 0)));
  CHECK(late->rotation.angularDistance(yaw(1.125)) < 1e-12);
}

TEST_CASE("A slerp takes the short way, whatever the quaternion's sign") {
  Eigen::Quaterniond negative = yaw(0.5);
  negative.coeffs() *= -1;
  const Pose halfway = interpolate(pose(0), {{0, 0, 0}, negative}, 0.5);
  CHECK(halfway.rotation.angularDistance(yaw(0.25)) < 1e-12);
}

TEST_CASE("There is no extrapolation") {
  OdometryBuffer odometry;
  CHECK_FALSE(odometry.at(0));
  odometry.add({100, pose(1)});
  odometry.add({200, pose(2)});
  CHECK_FALSE(odometry.at(99));
  REQUIRE(odometry.at(100));
  CHECK(odometry.at(100)->translation_m.x() == 1);
  REQUIRE(odometry.at(200));
  CHECK(odometry.at(200)->translation_m.x() == 2);
  CHECK_FALSE(odometry.at(201));
}

TEST_CASE("Poses that are no poses are refused, and change nothing") {
  OdometryBuffer odometry;
  odometry.add({100, pose(1)});
  CHECK(odometry.add({200, pose(NAN)}) == Add::not_finite);
  CHECK(odometry.add({200, pose(INFINITY)}) == Add::not_finite);
  CHECK(odometry.add({200, pose(1, NAN)}) == Add::not_finite);
  CHECK(odometry.add({200, {{0, 0, 0}, {0, 0, 0, 0}}}) == Add::not_finite);
  CHECK(odometry.add({200, pose(1e8)}) == Add::not_finite);
  CHECK(odometry.add({100, pose(5)}) == Add::not_newer);
  CHECK(odometry.add({99, pose(5)}) == Add::not_newer);
  CHECK(odometry.newest_ns() == 100);
  CHECK(odometry.at(100)->translation_m.x() == 1);
}

TEST_CASE("A full ring forgets its oldest pose") {
  OdometryBuffer odometry(3);
  for (int i = 0; i < 5; ++i) odometry.add({i * 100, pose(i)});
  CHECK(odometry.oldest_ns() == 200);
  CHECK_FALSE(odometry.at(199));
  CHECK(odometry.at(250)->translation_m.x() == Approx(2.5));
  CHECK(odometry.at(399)->translation_m.x() == Approx(3.99));
  odometry.clear();
  CHECK(odometry.empty());
  CHECK_FALSE(odometry.at(250));
}

// A tenth of a second at 12 m/s and half a radian a second, past a wall from y = -5 to 5 m at x = 20 m.
class FastDrive {
 public:
  FastDrive() {
    lidar_.T_base_sensor.translation() = Eigen::Vector3d(1, 0, 1.7);
    for (int i = 0; i <= 10; ++i) odometry_.add({i * 10'000'000, truth(i * 10'000'000)});
    sweep_.stamp_ns = 100'000'000;
    for (std::uint32_t i = 0; i <= 100; ++i) {
      sweep_.times_ns.push_back(i * 1'000'000);
      const Pose T = truth(sweep_.times_ns.back());
      const Eigen::Isometry3d T_odom_sensor =
          Eigen::Translation3d(T.translation_m) * T.rotation * lidar_.T_base_sensor;
      const Eigen::Vector3d p = T_odom_sensor.inverse() * Eigen::Vector3d(20.2, i * 0.1 - 5, 1.5);
      sweep_.returns.push_back({p.x(), p.y(), p.z(), i});
    }
  }

  /// Without times of their own, all returns are taken as of the sweep's stamp.
  void forget_times() {
    sweep_.times_ns = {sweep_.stamp_ns};
    for (Return& r : sweep_.returns) r.time_index = 0;
  }

  /// The world voxels in x in which anything was hit.
  std::set<int> wall() {
    SweepMapper mapper({}, lidar_, sweep_.returns.size());
    BrickMapStorage storage;
    const auto shape = mapper.count(sweep_, odometry_);
    REQUIRE(shape);
    mapper.write(storage.resize(*shape));
    const BrickMapView map = storage.view(mapper.grid(), sweep_.stamp_ns, mapper.T_odom_base());
    const Int3 n = map.grid.bricks();
    std::set<int> found;
    for (int slot = 0; slot < n[0] * n[1] * n[2]; ++slot)
      for (int cell = 0; map.directory[slot] >= 0 && cell < kBrickCells; ++cell)
        if (map.lookup[map.directory[slot] * kBrickCells + cell] >= 0)
          found.insert(map.grid.origin[0] + slot % n[0] * kBrickEdge + cell / 64);
    return found;
  }

 private:
  static Pose truth(std::int64_t time_ns) {
    const double t = static_cast<double>(time_ns) * 1e-9;
    return pose(12 * t, 0.5 * t);
  }

  LidarGeometry lidar_;
  OdometryBuffer odometry_;
  Sweep sweep_;
};

TEST_CASE("A wall seen at 12 m/s and turning stays one voxel thick") {
  CHECK(FastDrive().wall() == std::set<int>{50});  // 20.0 .. 20.4 m
}

TEST_CASE("Without times of their own the same returns smear the wall") {
  FastDrive drive;
  drive.forget_times();
  CHECK(drive.wall().size() >= 3);  // 1.2 m of driving
}

TEST_CASE("A sweep waits for the odometry and is not mapped beyond it") {
  OdometryBuffer odometry;
  Sweep sweep;
  sweep.stamp_ns = 200;
  sweep.times_ns = {150, 200};
  sweep.returns = {{5, 0, 0, 0}, {5, 0, 0, 1}};
  SweepMapper mapper({}, {}, 2);
  CHECK_FALSE(SweepMapper::is_due(sweep, odometry));
  odometry.add({100, pose(0)});
  odometry.add({199, pose(0)});
  CHECK_FALSE(SweepMapper::is_due(sweep, odometry));
  CHECK_FALSE(mapper.count(sweep, odometry));
  odometry.add({200, pose(0)});
  CHECK(SweepMapper::is_due(sweep, odometry));
  CHECK(mapper.count(sweep, odometry));
  sweep.times_ns[0] = 99;  // before the first pose
  CHECK_FALSE(mapper.count(sweep, odometry));
}

}  // namespace
}  // namespace gvom::test
