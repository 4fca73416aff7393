// A wrong extrinsic shows in the ground, on synthetic fields and real recordings; slopes and walls do not.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "services/ingest/ground_check.hpp"
#include "services/ingest/ground_plane.hpp"
#include "tests/ingest/recordings.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Matchers::Contains;
using ingest::GroundCheck;

namespace {

constexpr std::int64_t kHalfSecond_ns = 500'000'000;

LidarGeometry at(double z_m, double roll, double pitch, double yaw = 0, double x_m = 0) {
  LidarGeometry lidar;
  lidar.T_base_sensor.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  lidar.T_base_sensor.translation() << x_m, 0, z_m;
  return lidar;
}

/// What a lidar at `truth` sees of a field: z(x, y) in base_link, a point each half metre to 20 m.
template <class Height>
Sweep sweep_of(const LidarGeometry& truth, Height&& z_m) {
  Sweep sweep;
  sweep.times_ns = {0};
  const Eigen::Isometry3d T_sensor_base = truth.T_base_sensor.inverse();
  for (double y = -20; y <= 20; y += 0.5)
    for (double x = -20; x <= 20; x += 0.5) {
      const Eigen::Vector3d p = T_sensor_base * Eigen::Vector3d(x, y, z_m(x, y));
      sweep.returns.push_back({p.x(), p.y(), p.z(), 0});
    }
  return sweep;
}

double level(double, double) {
  return 0;
}

/// What the check says after `seconds` of that field, the vehicle driving at `speed_mps`.
struct Said {
  ipc::Ground ground;
  std::string words;
};
Said said_of(GroundCheck& check, Sweep sweep, double seconds, double speed_mps) {
  for (double t = 0; t < seconds; t += 0.5) {
    sweep.stamp_ns += kHalfSecond_ns;
    check.see(sweep, {t * speed_mps, 0, 0});
  }
  services::Words words;
  check.describe(words);
  return {check.ground(), std::string(words.text())};
}

Said said_of(const LidarGeometry& truth, const LidarGeometry& file, double speed_mps,
             const VehicleGeometry& vehicle = {}) {
  GroundCheck check(file, vehicle);
  return said_of(check, sweep_of(truth, level), 10, speed_mps);
}

bool is(const Said& said, ipc::GroundVerdict verdict) {
  return said.ground.verdict == static_cast<std::uint32_t>(verdict);
}

}  // namespace

TEST_CASE(
    "level ground under a right extrinsic is well, standing and on the way, at any height of base_link") {
  for (const double speed_mps : {0.0, 5.0}) {
    const Said said = said_of(at(1.5, 0.05, 0.1, 2.0), at(1.5, 0.05, 0.1, 2.0), speed_mps);
    CHECK(is(said, ipc::GroundVerdict::well));
    CHECK(said.words.empty());
    CHECK(std::abs(said.ground.height_m) < 1e-6);
    CHECK(said.ground.on_the_way == (speed_mps > 0 ? 1u : 0u));
  }
  VehicleGeometry vehicle;
  vehicle.base_height_m = 1.5;  // base_link is the lidar
  CHECK(is(said_of(at(1.5, 0, 0), at(0, 0, 0), 5, vehicle), ipc::GroundVerdict::well));
}

TEST_CASE("z with the wrong sign, or upside down, is told within 10 s, also of one that stands") {
  const Said said = said_of(at(1.45, 0, 0), at(-1.45, 0, 0), 0);
  CHECK(is(said, ipc::GroundVerdict::wrong));
  CHECK(said.words == "the ground is 2.9 m below where T_base_sensor and vehicle.base_height_m put it");
  CHECK_THAT(said_of(at(1.45, 0, 0), at(1.45, M_PI, 0), 0).words, Contains("2.9 m above"));
}

TEST_CASE("a wrong angle is told as an angle of T_base_sensor") {
  CHECK(said_of(at(1.5, 0, 0), at(1.5, 0, -0.4), 0).words ==
        "the ground is tilted by 23 degrees (pitch -0.40, roll 0.00): is T_base_sensor right?");
  CHECK_THAT(said_of(at(1.5, 0, 0, 3), at(1.5, 0, -0.4, 3), 5).words, Contains("pitch -0.40, roll"));
  CHECK_THAT(said_of(at(1.5, 0, 0), at(1.5, 0.1, 0), 5).words, Contains("pitch 0.00, roll 0.10"));
  CHECK_THAT(said_of(at(1.5, 0, 0, 1.6), at(1.5, 0.1, 0, 1.6), 5).words, Contains("roll 0.10"));
}

TEST_CASE("0.3 m are told on the way; where the vehicle stands they may be a kerb") {
  CHECK_THAT(said_of(at(1.5, 0, 0), at(1.8, 0, 0), 5).words, Contains("0.3 m above"));
  CHECK(is(said_of(at(1.5, 0, 0), at(1.8, 0, 0), 0), ipc::GroundVerdict::well));
  VehicleGeometry vehicle;
  vehicle.base_height_m = 0.3;  // forgotten in the file would be the same
  CHECK_THAT(said_of(at(1.5, 0, 0), at(1.5, 0, 0), 5, vehicle).words, Contains("0.3 m above"));
}

TEST_CASE("walls, a ditch and a bank beside the way leave the ground where it is") {
  const auto field = [](double x, double y) {
    if (y > 8) return 2.5;            // a wall along the way, seen from above
    if (x > 6 && x < 8) return -1.2;  // a ditch
    return y < -7 ? (-7 - y) * 0.5 : 0.02 * std::sin(7 * x + 3 * y);
  };
  GroundCheck check(at(1.5, 0, 0), {});
  const Said said = said_of(check, sweep_of(at(1.5, 0, 0), field), 10, 5);
  CHECK(is(said, ipc::GroundVerdict::well));
  CHECK(std::abs(said.ground.height_m) < 0.05);
}

TEST_CASE("a slope that passes is no fault, and one that the vehicle stands before is not either") {
  GroundCheck check(at(1.5, 0, 0), {});
  const Sweep flat = sweep_of(at(1.5, 0, 0), level);
  const Sweep before_slope = sweep_of(at(1.5, 0, 0), [](double x, double) { return 0.15 * x; });
  std::int64_t stamp_ns = 0;
  for (int i = 0; i < 60; ++i) {
    Sweep sweep = i % 6 == 5 ? before_slope : flat;
    sweep.stamp_ns = stamp_ns += kHalfSecond_ns;
    check.see(sweep, {2.5 * i, 0, 0});
    CHECK_FALSE(check.is_wrong());
  }
  GroundCheck standing(at(1.5, 0, 0), {});
  CHECK(is(said_of(standing, before_slope, 30, 0), ipc::GroundVerdict::well));
}

TEST_CASE("where hardly any ground is seen, nothing is judged, and what was seen a minute ago is forgotten") {
  GroundCheck check(at(1.5, 0, 0), {});
  const Said said = said_of(check, {}, 10, 5);
  CHECK(is(said, ipc::GroundVerdict::not_judged));
  CHECK(said.ground.sweeps == 0);

  said_of(check, sweep_of(at(1.5, 0, 0), level), 10, 5);
  Sweep later;
  later.stamp_ns = 200 * kHalfSecond_ns;
  check.see(later, {0, 0, 0});
  CHECK(check.ground().sweeps == 0);
}

namespace {

struct Recording {
  const char* uri;  // after "scans:DATA/" and the like
  double z_m, yaw, base_height_m;
  double x_m = 0;
};

/// The ground in each sweep; nothing where it is not found.
std::vector<ingest::GroundPlane> grounds(const std::string& uri, const LidarGeometry& lidar) {
  const auto source = open(uri);
  std::vector<ingest::GroundPlane> found;
  for (const Sweep& sweep : all_sweeps(*source))
    if (const auto plane = ingest::find_ground(sweep, lidar, {})) found.push_back(*plane);
  return found;
}

}  // namespace

TEST_CASE("the ground of real recordings is where their extrinsics put it, and tells wrong ones") {
  const auto data = recordings();
  if (!data) return;
  const Recording list[] = {{"kitti_drive0005", 1.73, 0, 0},
                            {"rellis_offroad/os1_64.bin", 1.4, 0, 0},
                            {"rellis_offroad/vlp32.bin", 1.308, 3.14159, 0, -0.252}};
  for (const Recording& r : list) {
    CAPTURE(r.uri);
    const std::string uri = "scans:" + *data + "/" + r.uri;
    const auto right = grounds(uri, at(r.z_m, 0, 0, r.yaw, r.x_m));
    REQUIRE(!right.empty());
    for (const auto& plane : right) {
      CHECK(std::abs(plane.height_m) < 0.25);  // the rear one's is known approximately
      CHECK(std::hypot(plane.slope_x, plane.slope_y) < 0.04);
    }
    for (const auto& plane : grounds(uri, at(-r.z_m, 0, 0, r.yaw, r.x_m)))
      CHECK(plane.height_m == Approx(-2 * r.z_m).margin(0.3));
    const auto pitched = grounds(uri, at(r.z_m, 0, -0.4, r.yaw, r.x_m));
    REQUIRE(!pitched.empty());
    for (const auto& plane : pitched) CHECK(std::atan(std::hypot(plane.slope_x, plane.slope_y)) > 0.35);
  }
  CHECK(grounds("scans:" + *data + "/forest/marv_ouster.pcd", at(0.408, 0, 0, 2.35619)).empty());
}
