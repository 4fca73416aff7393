// Which poses of live odometry follow from the ones before.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include "services/ingest/odometry_watch.hpp"

using namespace gvom;
using ingest::OdometryStep;
using ingest::OdometryWatch;

namespace {

/// Odometry whose messages come at their stamps; max_gap_s 0.5, max_speed_mps 40.
class Stream {
 public:
  OdometryStep step(double at_s, double x_m, double yaw_rad = 0) {
    StampedPose pose;
    pose.stamp_ns = std::llround(at_s * 1e9);
    pose.T_odom_base.translation_m = {x_m, 0, 0};
    pose.T_odom_base.rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
    const OdometryStep step = watch_.step(pose, pose.stamp_ns);
    if (step != OdometryStep::steady) buffer_.clear();
    watch_.note(buffer_.add(pose), pose.stamp_ns);
    return step;
  }
  [[nodiscard]] std::string says(double at_s) const {
    services::Words words;
    watch_.describe(std::llround(at_s * 1e9), words);
    return std::string(words.text());
  }
  [[nodiscard]] bool places(double at_s) const { return buffer_.at(std::llround(at_s * 1e9)).has_value(); }
  OdometryWatch& watch() { return watch_; }

 private:
  OdometryWatch watch_{services::OdometryConfig{}};
  OdometryBuffer buffer_;
};

}  // namespace

TEST_CASE("steady odometry of any rate down to the largest gap is left alone") {
  for (const double period_s : {0.005, 0.05, 0.1, 0.5}) {
    Stream stream;
    for (int i = 0; i < 20; ++i)
      CHECK(stream.step(10 + i * period_s, 12 * i * period_s) == OdometryStep::steady);
    CHECK(stream.says(10 + 19 * period_s).empty());
    CHECK(stream.places(10.05));
  }
}

TEST_CASE("nothing is placed within a gap, and it is told while it lasts and after") {
  Stream stream;
  for (int i = 0; i <= 10; ++i) stream.step(10 + i * 0.1, 0);
  CHECK(stream.says(11.5).empty());
  CHECK(stream.says(12.2) == "no odometry for 1.2 s");
  CHECK(stream.step(12.5, 18) == OdometryStep::gap);
  CHECK(!stream.places(11.5));
  CHECK(stream.says(12.5) ==
        "odometry has a gap of 1.50 s, more than odometry.max_gap_s 0.5: no sweep in it is mapped");
  for (int i = 1; i <= 30; ++i) CHECK(stream.step(12.5 + i * 0.1, 18) == OdometryStep::steady);
  CHECK(stream.places(13.05));
  CHECK(stream.says(15.5).empty());
}

TEST_CASE("odometry at 1 Hz is all gaps, and that stays told") {
  Stream stream;
  stream.step(10, 0);
  for (int i = 1; i < 5; ++i) {
    CHECK(stream.step(10 + i, 0) == OdometryStep::gap);
    CHECK(!stream.places(9.5 + i));
    CHECK(stream.says(10.4 + i).find("gap of 1.00 s") != std::string::npos);
  }
}

TEST_CASE("a jump is what no vehicle drives or turns; half a metre is noise") {
  Stream stream;
  stream.step(10, 0);
  CHECK(stream.step(10.1, 3.9) == OdometryStep::steady);  // 39 m/s
  CHECK(stream.step(10.2, 8.9) == OdometryStep::jump);    // 50 m/s
  CHECK(!stream.places(10.15));
  CHECK(stream.says(10.2) == "odometry jumped by 5.0 m: the map begins anew");
  CHECK(stream.says(11.3).find("jump") == std::string::npos);
  CHECK(stream.step(10.201, 9.3) == OdometryStep::steady);  // 400 m/s, but 0.4 m
  CHECK(stream.step(10.301, 9.3, 0.6) == OdometryStep::steady);
  CHECK(stream.step(10.401, 9.3, 1.3) == OdometryStep::jump);  // 7 rad/s
}

TEST_CASE("poses that are none or go back are told; one that was far ahead is got over") {
  Stream stream;
  stream.step(10, 0);
  CHECK(stream.step(10.1, std::numeric_limits<double>::quiet_NaN()) == OdometryStep::steady);
  CHECK(stream.says(10.1) == "odometry is not a pose: not used");
  CHECK(stream.step(9.9, 0) == OdometryStep::steady);
  CHECK(stream.says(10.1) == "odometry goes back in time: not used; odometry is not a pose: not used");
  CHECK(stream.step(10.2, 0) == OdometryStep::steady);

  CHECK(stream.step(3600, 0) == OdometryStep::gap);
  for (int i = 0; i < 7; ++i) CHECK(stream.step(10.3 + i * 0.1, 0) == OdometryStep::steady);
  CHECK(stream.step(11.0, 0) == OdometryStep::anew);
  CHECK(stream.step(11.1, 0) == OdometryStep::steady);
  CHECK(stream.places(11.05));
}

TEST_CASE("a new epoch follows nothing") {
  Stream stream;
  stream.step(10, 0);
  stream.watch().begin_anew();
  CHECK(stream.step(5, 100) == OdometryStep::steady);
  CHECK(stream.step(5.1, 100) == OdometryStep::steady);
}
