// How far a lidar's clock is from the odometry's, and what that makes of its sweeps.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <string>

#include "services/ingest/loss_words.hpp"

using namespace gvom;
using namespace gvom::ingest;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kBoot_ns = 500 * kSecond;  // of this machine's CLOCK_MONOTONIC, when the drive begins

/// A vehicle that stands: odometry at 20 Hz and a lidar at 10 Hz, each with a clock and a delay of its own.
class Vehicle {
 public:
  explicit Vehicle(std::int64_t odometry_begin_ns = 1'700'000'000 * kSecond)
      : intake_(services::OdometryConfig{}, OdometryIntake::Sweeps::live), begin_ns_(odometry_begin_ns) {}

  void pose(std::int64_t t_ns, std::int64_t delay_ns = 2 * kMs) {
    intake_.take({{begin_ns_ + t_ns, {}}, 1}, kBoot_ns + t_ns + delay_ns);
  }
  /// Its last return is that of the middle of the turn; what is behind is sky.
  static Sweep sweep(std::int64_t stamp_ns, std::int64_t received_ns) {
    Sweep sweep;
    sweep.times_ns = {stamp_ns - 100 * kMs, stamp_ns - 50 * kMs, stamp_ns};
    sweep.returns = {{5, 0, 0, 0}, {5, 0, 0, 1}};
    sweep.stamp_ns = stamp_ns - 50 * kMs;
    sweep.received_ns = received_ns;
    return sweep;
  }
  /// What becomes, in the end, of a sweep that ended at `t_ns`, of a clock that is so far ahead.
  Placement place(std::int64_t t_ns, std::int64_t ahead_ns, std::int64_t delay_ns = 5 * kMs) {
    const std::int64_t received_ns = kBoot_ns + t_ns + delay_ns;
    const Sweep sweep = Vehicle::sweep(begin_ns_ + t_ns + ahead_ns, received_ns);
    for (std::int64_t waited_ns = 0; waited_ns <= 2 * kSecond; waited_ns += 10 * kMs) {
      const Placement placement = intake_.judge(sweep, received_ns, received_ns + waited_ns);
      if (placement.when == Placement::When::never)
        intake_.note(sweep, placement.why, received_ns + waited_ns);
      if (placement.when != Placement::When::later) return placement;
      now_ns_ = received_ns + waited_ns;
    }
    return {};
  }
  bool maps(std::int64_t t_ns, std::int64_t ahead_ns, std::int64_t delay_ns = 5 * kMs) {
    return place(t_ns, ahead_ns, delay_ns).when == Placement::When::now;
  }
  bool refuses(std::int64_t t_ns, std::int64_t ahead_ns, std::int64_t delay_ns = 5 * kMs) {
    const Placement placement = place(t_ns, ahead_ns, delay_ns);
    return placement.when == Placement::When::never && placement.why == SweepLoss::clock;
  }
  [[nodiscard]] std::string says() const {
    services::Words words;
    intake_.describe(now_ns_, words);
    return std::string(words.text());
  }
  OdometryIntake& intake() { return intake_; }

 private:
  OdometryIntake intake_;
  std::int64_t begin_ns_;
  std::int64_t now_ns_ = 0;
};

void drive(Vehicle& vehicle, std::int64_t until_ns, std::int64_t from_ns = 0) {
  for (std::int64_t t = from_ns; t <= until_ns; t += 50 * kMs) vehicle.pose(t);
}

}  // namespace

TEST_CASE("a clock that is beyond the limit is refused from the first sweep on, in both directions") {
  for (const double ahead_s : {-1800.0, -37.0, -2.0, -0.3, 0.3, 2.0, 37.0, 86400.0}) {
    INFO(ahead_s);
    Vehicle vehicle;
    drive(vehicle, 3 * kSecond);
    CHECK(vehicle.refuses(2 * kSecond, std::llround(ahead_s * 1e9)));
    CHECK(vehicle.refuses(2100 * kMs, std::llround(ahead_s * 1e9)));
  }
}

TEST_CASE("delays of packets and odometry below the limit are no other clock") {
  for (const std::int64_t packet_ms : {0, 5, 100, 200})
    for (const std::int64_t pose_ms : {0, 20, 100, 200}) {
      Vehicle vehicle;
      for (std::int64_t t = 0; t <= 3 * kSecond; t += 50 * kMs) vehicle.pose(t, pose_ms * kMs);
      CHECK(vehicle.maps(2 * kSecond, 0, packet_ms * kMs));
    }
}

TEST_CASE("odometry that was held up once, or that we were late to take, makes no clock wrong") {
  Vehicle vehicle;
  drive(vehicle, 2 * kSecond);
  vehicle.pose(2050 * kMs, 450 * kMs);
  CHECK(vehicle.maps(2 * kSecond, 0));
  vehicle.pose(2100 * kMs, 400 * kMs);
  CHECK(vehicle.maps(2100 * kMs, 0));
  // Asleep for two and a half seconds: all at once, and only the newest says how late it is.
  for (std::int64_t t = 2150 * kMs; t <= 5 * kSecond; t += 50 * kMs) vehicle.pose(t, 5 * kSecond - t + kMs);
  CHECK(vehicle.maps(5 * kSecond, 0));
}

TEST_CASE("the first odometry may be an old one: a sweep waits a moment for the next") {
  Vehicle vehicle;
  vehicle.pose(0, 400 * kMs);
  const std::int64_t received_ns = kBoot_ns + 405 * kMs;
  const Sweep sweep = Vehicle::sweep(1'700'000'000 * kSecond + 400 * kMs, received_ns);
  CHECK(vehicle.intake().judge(sweep, received_ns, received_ns).when == Placement::When::later);
  for (std::int64_t t = 50 * kMs; t <= 450 * kMs; t += 50 * kMs) vehicle.pose(t, 452 * kMs - t);
  CHECK(vehicle.intake().judge(sweep, received_ns, received_ns + 50 * kMs).when == Placement::When::now);
}

TEST_CASE("a clock that changes is seen with its next sweep, that of a lidar and that of the odometry") {
  Vehicle vehicle;
  drive(vehicle, 3 * kSecond);
  CHECK(vehicle.maps(2 * kSecond, 0));
  CHECK(vehicle.refuses(2100 * kMs, -2 * kSecond));
  CHECK(vehicle.maps(2200 * kMs, 0));
  // From 3.05 s on the odometry's clock is 1.95 s ahead, with a gap.
  for (std::int64_t t = 3050 * kMs; t <= 3300 * kMs; t += 50 * kMs)
    vehicle.intake().take({{1'700'000'000 * kSecond + t + 1950 * kMs, {}}, 1}, kBoot_ns + t);
  CHECK(vehicle.refuses(3200 * kMs, 0));
  CHECK(vehicle.maps(3200 * kMs, 1950 * kMs));
}

TEST_CASE("what is known of an offset is said") {
  const auto says = [](std::int64_t odometry_s, double lidar_s) {
    Vehicle vehicle(odometry_s * kSecond);
    drive(vehicle, 3 * kSecond);
    CHECK(vehicle.refuses(2 * kSecond, std::llround(lidar_s * 1e9) - odometry_s * kSecond));
    return vehicle.says();
  };
  const std::string tail = ": nothing is mapped beyond odometry.max_clock_offset_s 0.25";
  constexpr std::int64_t kUnix = 1'700'000'000;
  CHECK(says(kUnix, kUnix - 2.0) == "the lidar's clock is 2.0 s behind the odometry's" + tail);
  CHECK(says(kUnix, kUnix + 2.0) == "the lidar's clock is 2.0 s ahead of the odometry's" + tail);
  CHECK(says(kUnix, kUnix + 37.0) ==
        "the lidar's clock is 37.0 s ahead of the odometry's (that is TAI - UTC)" + tail);
  CHECK(says(kUnix, kUnix - 37.1).find("(that is TAI - UTC)") != std::string::npos);
  CHECK(says(kUnix, kUnix + 18.1).find("(that is GPS - UTC)") != std::string::npos);
  CHECK(says(kUnix, kUnix - 1000).find("(") == std::string::npos);
  CHECK(says(kUnix, 991).find("(the lidar's counts from its boot)") != std::string::npos);
  CHECK(says(991, kUnix).find("(the odometry's counts from its boot)") != std::string::npos);
}

TEST_CASE("recordings that never meet are guessed at if there is one way only in which they would") {
  const auto span = [](double first_s, double last_s) {
    return TimeSpan{std::llround(first_s * 1e9), std::llround(last_s * 1e9)};
  };
  const std::string tai = "that is TAI - UTC";
  CHECK(guess_clock(span(991.6, 991.9), span(1028.6, 1028.9)) == tai);
  CHECK(guess_clock(span(1028.6, 1028.9), span(991.6, 991.9)) == tai);
  CHECK(guess_clock(span(991.6, 991.9), span(973.6, 973.9)) == std::string("that is GPS - UTC"));
  CHECK(guess_clock(span(991.6, 991.9), span(900, 980)) == std::string());  // 18, 19 or 37 would do
  CHECK(guess_clock(span(991.6, 991.9), span(1.65e9, 1.65e9 + 9)) ==
        std::string("the lidar's counts from its boot"));
  CHECK(guess_clock(span(1.65e9, 1.65e9 + 9), span(10, 20)) ==
        std::string("the odometry's counts from its boot"));
  CHECK(guess_clock(span(10, 20), span(30, 40)) == std::string());
}

TEST_CASE("recordings of one drive that meet in part are guessed at by their begins and ends") {
  const auto span = [](double first_s, double last_s) {
    return TimeSpan{std::llround(first_s * 1e9), std::llround(last_s * 1e9)};
  };
  CHECK(guess_shift(span(1000, 1060), span(1037.4, 1096.8)) == std::string("that is TAI - UTC"));
  CHECK(guess_shift(span(1018.2, 1078.1), span(1000, 1060)) == std::string("that is GPS - UTC"));
  CHECK(guess_shift(span(1019.1, 1079.2), span(1000, 1060)) == std::string("that is TAI - GPS"));
  CHECK(guess_shift(span(1000, 1060), span(1037, 1120)) == std::string());  // another drive, or a longer one
  CHECK(guess_shift(span(1000, 1060), span(1005, 1060)) == std::string());  // localised late
}

TEST_CASE("whatever is late and however, the measured offset is off by no more than the least delays") {
  std::mt19937 random(3);
  std::exponential_distribution<double> delay_ms(1.0 / 30);
  for (int round = 0; round < 200; ++round) {
    ClockCheck check;
    const std::int64_t ahead_ns = static_cast<std::int64_t>(random() % 4000) * kMs - 2 * kSecond;
    std::int64_t least_ns = 10 * kSecond;
    std::int64_t came_ns = 0;
    for (std::int64_t t = 0; t <= 2 * kSecond; t += 50 * kMs) {
      came_ns = std::max<std::int64_t>(came_ns, t + std::llround(delay_ms(random) * 1e6));
      if (t >= 1500 * kMs) least_ns = std::min(least_ns, came_ns - t);
      check.take_odometry(t, kBoot_ns + came_ns);
    }
    const std::int64_t late_ns = std::llround(delay_ms(random) * 1e6);
    const auto measured = check.ahead_ns(2 * kSecond + ahead_ns, kBoot_ns + 2 * kSecond + late_ns);
    REQUIRE(measured);
    CHECK(*measured <= ahead_ns - late_ns + least_ns);
    CHECK(*measured >= ahead_ns - late_ns);
  }
}
