// Which returns count (R2), at the exact boundaries.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/cpu/voxelizer.hpp"

namespace gvom::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

class Filter {
 public:
  Filter() {
    lidar_.min_range_m = 1;
    lidar_.max_range_m = 100;
    lidar_.T_base_sensor.translation() = Eigen::Vector3d(0, 0, 2);
    vehicle_.body = Box{{-2, -1, 0}, {3, 1, 1}};
  }

  /// Which counter a return raises; it must be one only, and only a used one may leave a trace.
  std::string judge(double x_m, double y_m, double z_m) {
    MapConfig map;
    cpu::Voxelizer voxelizer(map, lidar_, vehicle_, 1);
    Sweep sweep;
    sweep.times_ns = {0};
    sweep.returns = {{x_m, y_m, z_m, 0}};
    const BrickMapShape shape =
        voxelizer.count(sweep, {Pose{}}, grid_around(map, Eigen::Vector3d::Zero())).value();
    const FilterCounts& c = voxelizer.filter_counts();
    REQUIRE(c.used + c.not_finite + c.too_near + c.too_far + c.body == 1);
    REQUIRE((shape.brick_count > 0) == (c.used == 1));
    return c.used ? "used" : c.not_finite ? "not finite" : c.too_near ? "near" : c.too_far ? "far" : "body";
  }

 private:
  LidarGeometry lidar_;
  VehicleGeometry vehicle_;
};

double just_over(double value) {
  return std::nextafter(value, kInf);
}
double just_under(double value) {
  return std::nextafter(value, -kInf);
}

TEST_CASE("A return counts from the minimum to the maximum range") {
  Filter filter;
  CHECK(filter.judge(0, 0, 1) == "used");
  CHECK(filter.judge(0, 0, just_under(1)) == "near");
  CHECK(filter.judge(0, 0, 0) == "near");
  CHECK(filter.judge(-100, 0, 0) == "used");
  CHECK(filter.judge(0, just_over(100), 0) == "far");
  CHECK(filter.judge(60, 80, 0) == "used");
  CHECK(filter.judge(60.001, 80, 0) == "far");
}

TEST_CASE("A return that is not finite is counted as such") {
  Filter filter;
  CHECK(filter.judge(NAN, 2, 2) == "not finite");
  CHECK(filter.judge(2, -NAN, 2) == "not finite");
  CHECK(filter.judge(2, 2, kInf) == "not finite");
  CHECK(filter.judge(-kInf, kInf, 2) == "not finite");
}

TEST_CASE("A finite return is too far however far it is") {
  Filter filter;
  CHECK(filter.judge(1e200, 0, 0) == "far");
  CHECK(filter.judge(-std::numeric_limits<double>::max(), 1e300, 0) == "far");
}

TEST_CASE("The body box is measured in base_link and its faces are the vehicle") {
  Filter filter;  // the sensor is 2 m above base_link
  CHECK(filter.judge(0, 0, -1) == "body");
  CHECK(filter.judge(0, 0, just_over(-1)) == "near");  // nearer than the minimum: that reason comes first
  CHECK(filter.judge(3, 1, -1) == "body");
  CHECK(filter.judge(just_over(3), 1, -1) == "used");
  CHECK(filter.judge(3, just_over(1), -1) == "used");
  CHECK(filter.judge(-2, -1, -2) == "body");
  CHECK(filter.judge(just_under(-2), -1, -2) == "used");
  CHECK(filter.judge(-2, -1, -2.001) == "used");
}

}  // namespace
}  // namespace gvom::test
