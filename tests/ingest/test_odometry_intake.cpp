// Which odometry is used, and which sweeps it can place.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include "services/ingest/loss_words.hpp"

using namespace gvom;
using namespace gvom::ingest;

namespace {

std::int64_t ns(double s) {
  return std::llround(s * 1e9);
}

/// Odometry whose messages come at their stamps; max_gap_s 0.5, max_speed_mps 40, timeout_s 1.
class Stream {
 public:
  explicit Stream(OdometryIntake::Sweeps sweeps = OdometryIntake::Sweeps::live)
      : intake_(services::OdometryConfig{}, sweeps) {}

  Taken take(double at_s, double x_m, double yaw_rad = 0) {
    StampedPose pose;
    pose.stamp_ns = ns(at_s);
    pose.T_odom_base.translation_m = {x_m, 0, 0};
    pose.T_odom_base.rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
    return intake_.take({pose, epoch_}, ns(at_s));
  }
  void end(double at_s) { intake_.take({{}, epoch_, true}, ns(at_s)); }
  void begin_epoch(std::uint64_t epoch) { epoch_ = epoch; }
  [[nodiscard]] std::string says(double at_s) const {
    services::Words words;
    intake_.describe(ns(at_s), words);
    CHECK((intake_.faults(ns(at_s)) == 0) == words.empty());
    return std::string(words.text());
  }
  [[nodiscard]] bool places(double at_s) const { return intake_.poses().at(ns(at_s)).has_value(); }
  /// A sweep of a tenth of a second that came at its stamp.
  [[nodiscard]] Placement judge(double stamp_s, double now_s = 0) const {
    Sweep sweep;
    sweep.stamp_ns = ns(stamp_s);
    sweep.times_ns = {ns(stamp_s - 0.1), ns(stamp_s)};
    sweep.returns = {{5, 0, 0, 0}, {5, 0, 0, 1}};
    return intake_.judge(sweep, ns(stamp_s), now_s == 0 ? ns(stamp_s) : ns(now_s));
  }
  [[nodiscard]] bool waits(double stamp_s, double now_s = 0) const {
    return judge(stamp_s, now_s).when == Placement::When::later;
  }
  [[nodiscard]] bool maps(double stamp_s) const { return judge(stamp_s).when == Placement::When::now; }
  [[nodiscard]] bool loses(SweepLoss why, double stamp_s, double now_s = 0) const {
    const Placement placement = judge(stamp_s, now_s);
    return placement.when == Placement::When::never && placement.why == why;
  }
  OdometryIntake& intake() { return intake_; }

 private:
  OdometryIntake intake_;
  std::uint64_t epoch_ = 1;
};

}  // namespace

TEST_CASE("steady odometry of any rate down to the largest gap is left alone") {
  for (const double period_s : {0.005, 0.05, 0.1, 0.5}) {
    Stream stream;
    for (int i = 0; i < 20; ++i) CHECK(stream.take(10 + i * period_s, 12 * i * period_s) == Taken::used);
    CHECK(stream.says(10 + 19 * period_s).empty());
    CHECK(stream.places(10.05));
  }
}

TEST_CASE("nothing is placed within a gap, and it is told while it lasts and after") {
  Stream stream;
  for (int i = 0; i <= 10; ++i) stream.take(10 + i * 0.1, 0);
  CHECK(stream.says(11.5).empty());
  CHECK(stream.says(12.2) == "no odometry for 1.2 s");
  CHECK(stream.take(12.5, 18) == Taken::gap);
  CHECK(!stream.places(11.5));
  CHECK(stream.says(12.5) ==
        "odometry has a gap of 1.50 s, more than odometry.max_gap_s 0.5: no sweep in it is mapped");
  for (int i = 1; i <= 30; ++i) CHECK(stream.take(12.5 + i * 0.1, 18) == Taken::used);
  CHECK(stream.places(13.05));
  CHECK(stream.says(15.5).empty());
  CHECK(stream.maps(11));
  CHECK(stream.loses(SweepLoss::gap, 11.01));
  CHECK(stream.loses(SweepLoss::gap, 12.5));
  CHECK(stream.loses(SweepLoss::gap, 12.59));
  CHECK(stream.maps(12.6));
}

TEST_CASE("odometry at 1 Hz is all gaps, and that stays told") {
  Stream stream;
  stream.take(10, 0);
  for (int i = 1; i < 5; ++i) {
    CHECK(stream.take(10 + i, 0) == Taken::gap);
    CHECK(!stream.places(9.5 + i));
    CHECK(stream.says(10.4 + i).find("gap of 1.00 s") != std::string::npos);
  }
}

TEST_CASE("a jump is what no vehicle drives or turns; half a metre is noise") {
  Stream stream;
  stream.take(10, 0);
  CHECK(stream.take(10.1, 3.9) == Taken::used);  // 39 m/s
  CHECK(stream.take(10.2, 8.9) == Taken::jump);  // 50 m/s
  CHECK(!stream.places(10.15));
  CHECK(stream.loses(SweepLoss::jump, 10.2));
  CHECK(stream.maps(10.1));
  CHECK(stream.intake().poses().jump_before(ns(10.1)) == 0);
  CHECK(stream.says(10.2) == "odometry jumped by 5.0 m: the map begins anew");
  CHECK(stream.says(11.3).find("jump") == std::string::npos);
  CHECK(stream.take(10.201, 9.3) == Taken::used);  // 400 m/s, but 0.4 m
  CHECK(stream.intake().poses().jump_before(ns(10.201)) == ns(10.2));
  CHECK(stream.take(10.301, 9.3, 0.6) == Taken::used);
  CHECK(stream.take(10.401, 9.3, 1.3) == Taken::jump);  // 7 rad/s
}

TEST_CASE("poses that are none or go back are told; one that was far ahead is got over") {
  Stream stream;
  stream.take(10, 0);
  CHECK(stream.take(10.1, std::numeric_limits<double>::quiet_NaN()) == Taken::not_a_pose);
  CHECK(stream.says(10.1) == "odometry is not a pose: not used");
  CHECK(stream.take(9.9, 0) == Taken::backwards);
  CHECK(stream.says(10.1) == "odometry goes back in time: not used; odometry is not a pose: not used");
  CHECK(stream.take(10.2, 0) == Taken::used);

  CHECK(stream.take(3600, 0) == Taken::gap);
  for (int i = 0; i < 7; ++i) CHECK(stream.take(10.3 + i * 0.1, 0) == Taken::backwards);
  CHECK(stream.take(11.0, 0) == Taken::anew);
  CHECK(stream.take(11.1, 0) == Taken::used);
  CHECK(stream.places(11.05));
  CHECK(stream.intake().counts().not_finite == 1);
  CHECK(stream.intake().counts().not_newer == 8);
}

TEST_CASE("a pose that is repeated, however often, is counted and changes nothing") {
  Stream stream;
  for (int i = 0; i < 40; ++i) {
    CHECK(stream.take(10 + i * 0.1, 0) == Taken::used);
    for (int again = 0; again < 10; ++again) CHECK(stream.take(10 + i * 0.1, 0) == Taken::backwards);
  }
  CHECK(stream.places(10.05));
  CHECK(stream.intake().poses().jump_before(ns(13.9)) == 0);
  CHECK(stream.says(13.9).find("back in time") == std::string::npos);
  CHECK(stream.intake().counts().not_newer == 400);
}

TEST_CASE("a new epoch follows nothing, and an old one is not used, but counted and told") {
  Stream stream;
  stream.take(10, 0);
  stream.begin_epoch(2);
  CHECK(stream.take(5, 100) == Taken::used);
  CHECK(!stream.places(10));
  CHECK(stream.take(5.1, 100) == Taken::used);
  stream.begin_epoch(1);
  CHECK(stream.take(5.2, 0) == Taken::old_epoch);
  CHECK(!stream.places(5.15));
  CHECK(stream.says(5.2) == "odometry of an old epoch: not used");
  CHECK(stream.intake().counts().old_epoch == 1);
  CHECK(stream.intake().counts().poses == 3);
}

TEST_CASE("a live sweep waits from when it came until the timeout, also after an end of stream") {
  Stream stream;
  CHECK(stream.waits(10, 10.9));
  CHECK(stream.loses(SweepLoss::timeout, 10, 11.1));
  stream.take(9, 0);
  stream.take(9.4, 0);
  CHECK(stream.waits(10, 10.9));
  stream.end(9.5);
  CHECK(stream.waits(10, 10.9));
  CHECK(stream.loses(SweepLoss::timeout, 10, 11.1));
  CHECK(stream.says(30).find("no odometry for") == 0);
}

TEST_CASE("a recorded sweep waits until the odometry's end, however long that takes") {
  Stream stream(OdometryIntake::Sweeps::recorded);
  stream.take(9.9, 0);
  CHECK(stream.waits(10, 1000));
  CHECK(stream.says(1000).empty());
  stream.take(10, 0);
  CHECK(stream.maps(10));
  CHECK(stream.loses(SweepLoss::before_odometry, 9.95));
  CHECK(stream.waits(11));
  stream.end(11);
  CHECK(stream.loses(SweepLoss::after_odometry, 11));
  CHECK(stream.maps(10));
}

TEST_CASE("what was lost is told by reason, with the key or the times that decided") {
  Stream stream(OdometryIntake::Sweeps::recorded);
  for (int i = 0; i <= 100; ++i) stream.take(10 + i * 0.1, 0);
  SweepLosses losses;
  for (int i = 0; i < 3; ++i) losses.count(SweepLoss::after_odometry, ns(991.6 + 0.1 * i));
  losses.count(SweepLoss::gap, ns(12));
  CHECK(losses.all() == 4);
  const auto lines = explain(losses, stream.intake());
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] ==
        "3 sweeps not mapped: after the odometry: odometry spans 10.0 .. 20.0 s, sweeps 991.6 .. 991.8 "
        "s; for clocks that differ there are lidars.NAME.clock_offset_s and lidars.NAME.clock: arrival");
  CHECK(lines[1] ==
        "1 sweeps not mapped: in a gap of the odometry (odometry.max_gap_s is 0.5): odometry spans 10.0 .. "
        "20.0 "
        "s, sweeps 12.0 .. 12.0 s");
}

TEST_CASE("where the odometry goes back in time for good, maps from before must go, as after a jump") {
  Stream stream;
  for (int i = 0; i <= 20; ++i) stream.take(100 + i * 0.1, 0);
  CHECK(stream.intake().poses().jump_before(ns(102)) == 0);
  for (int i = 0; i <= 8; ++i) stream.take(40 + i * 0.1, 0);
  CHECK(stream.intake().poses().jump_before(ns(40.8)) == ns(40.7));  // the eighth that went back
  CHECK(stream.maps(40.8));
  CHECK(stream.loses(SweepLoss::before_odometry, 40.75));
}

TEST_CASE("one stamp of long ago is no gap that is told for years") {
  Stream stream;
  stream.intake().take({{0, {}}, 0}, ns(1000));
  for (int i = 0; i <= 700; ++i) stream.intake().take({{ns(1.7e9 + i * 0.1), {}}, 0}, ns(1000 + i * 0.1));
  CHECK(stream.says(1010).find("odometry has a gap of ") == 0);
  CHECK(stream.says(1070).empty());
}
