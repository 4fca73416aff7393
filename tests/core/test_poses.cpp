// Poses between odometry (R3), and what they do to a sweep that was measured on the move.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
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
  CHECK(odometry.reach(span_of(sweep)) == Reach::later);
  odometry.add({100, pose(0)});
  odometry.add({199, pose(0)});
  CHECK(odometry.reach(span_of(sweep)) == Reach::later);
  CHECK_FALSE(mapper.count(sweep, odometry));
  odometry.add({200, pose(0)});
  CHECK(odometry.reach(span_of(sweep)) == Reach::covered);
  CHECK(mapper.count(sweep, odometry));
  sweep.times_ns[0] = 99;  // before the first pose
  CHECK(odometry.reach(span_of(sweep)) == Reach::before);
  CHECK_FALSE(mapper.count(sweep, odometry));
}

TEST_CASE("A time without a return needs no pose, before the first return or after the last") {
  OdometryBuffer odometry;
  odometry.add({100, pose(0)});
  odometry.add({200, pose(1)});
  Sweep sweep;
  sweep.stamp_ns = 200;
  sweep.times_ns = {90, 150, 200, 210};
  sweep.returns = {{5, 0, 0, 1}, {5, 0, 0, 2}};
  SweepMapper mapper({}, {}, 3);
  CHECK(mapper.count(sweep, odometry));
  CHECK(mapper.T_odom_base().translation_m.x() == 1);
  CHECK(mapper.filter_counts().used == 2);
  sweep.returns.push_back({5, 0, 0, 0});  // but with a return it does
  CHECK_FALSE(mapper.count(sweep, odometry));
  sweep.returns.back().time_index = 3;
  CHECK_FALSE(mapper.count(sweep, odometry));
  sweep.returns.clear();  // a sweep of the sky: its stamp alone
  CHECK(mapper.count(sweep, odometry));
}

TEST_CASE("Across a gap or a jump nothing is placed, beside it everything") {
  for (const auto& [link, reach] :
       {std::pair(PoseLink::gap, Reach::gap), std::pair(PoseLink::jump, Reach::jump)}) {
    OdometryBuffer odometry;
    for (int i = 0; i < 10; ++i) odometry.add({i * 100, pose(i)}, i == 5 ? link : PoseLink::steady);
    CHECK(odometry.at(400));
    CHECK_FALSE(odometry.at(401));
    CHECK_FALSE(odometry.at(499));
    CHECK(odometry.at(500));
    CHECK(odometry.reach({350, 400}) == Reach::covered);
    CHECK(odometry.reach({350, 401}) == reach);
    CHECK(odometry.reach({410, 420}) == reach);
    CHECK(odometry.reach({400, 500}) == reach);  // moments on both sides
    CHECK(odometry.reach({499, 800}) == reach);
    CHECK(odometry.reach({500, 900}) == Reach::covered);
    const std::int64_t jump_ns = link == PoseLink::jump ? 500 : 0;
    CHECK(odometry.jump_before(499) == 0);
    CHECK(odometry.jump_before(500) == jump_ns);
    CHECK(odometry.jump_before(850) == jump_ns);
  }
}

/// Whether each moment of the span lies between two poses that follow steadily, looked at one by one.
bool is_covered_slowly(const std::vector<std::pair<std::int64_t, PoseLink>>& poses, const TimeSpan& span) {
  for (std::int64_t t = span.first_ns; t <= span.last_ns; ++t) {
    bool there = false;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const bool inside = i > 0 && poses[i - 1].first <= t && t <= poses[i].first;
      there = there || poses[i].first == t || (inside && poses[i].second == PoseLink::steady);
      if (inside && poses[i].second != PoseLink::steady && span.first_ns < poses[i].first &&
          poses[i].first <= span.last_ns)
        return false;  // across it
    }
    if (!there) return false;
  }
  return true;
}

TEST_CASE("What is covered is what has a pose at each of its moments") {
  std::minstd_rand random(7);
  for (int round = 0; round < 3000; ++round) {
    OdometryBuffer odometry(1 + random() % 6);
    std::vector<std::pair<std::int64_t, PoseLink>> poses;
    std::int64_t t = 0;
    for (std::size_t i = random() % 9; i > 0; --i) {
      t += 1 + static_cast<std::int64_t>(random() % 5);
      const auto link = random() % 3 == 0 ? PoseLink::gap : PoseLink::steady;
      poses.emplace_back(t, link);
      odometry.add({t, pose(0)}, link);
    }
    while (!poses.empty() && poses.front().first < odometry.oldest_ns()) poses.erase(poses.begin());
    const auto first = static_cast<std::int64_t>(random() % 40) - 3;
    const TimeSpan span{first, first + static_cast<std::int64_t>(random() % 12)};
    INFO(round << ": " << span.first_ns << " .. " << span.last_ns);
    CHECK((odometry.reach(span) == Reach::covered) == is_covered_slowly(poses, span));
    if (odometry.reach(span) != Reach::covered) continue;
    for (std::int64_t at = span.first_ns; at <= span.last_ns; ++at) CHECK(odometry.at(at));
  }
}

}  // namespace
}  // namespace gvom::test
