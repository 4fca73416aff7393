// How near times by arrival come to the truth on a network that delays, and what starts them anew.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "services/ingest/arrival_clock.hpp"

using namespace gvom;
using namespace gvom::ingest;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kUnix_ns = 1'700'000'000 * kSecond;
constexpr std::int64_t kPacket_ns = kSecond / 640;  // an Ouster's: 64 a turn, 10 turns a second
constexpr std::int64_t kLeast_ns = 200'000;         // no packet is faster

/// A network whose packets keep their order.
struct Network {
  double mean_ms;  ///< Of an exponential delay on top of the least.
  std::int64_t burst_ns =
      0;  ///< Each five seconds nothing comes for so long, then all at once; not at first.
};

struct Errors {
  double median_us;
  double p99_us;
  double most_us;
};

Errors errors_of(std::vector<double> errors_us) {
  std::sort(errors_us.begin(), errors_us.end());
  const auto at = [&](double share) {
    return errors_us[static_cast<std::size_t>(share * static_cast<double>(errors_us.size() - 1))];
  };
  return {at(0.5), at(0.99), at(1)};
}

struct Run {
  Errors raw;       ///< Of the packets' own arrivals.
  Errors smoothed;  ///< Of the newest time of each sweep, from the first sweep on.
  double sweep_us;  ///< Most that a sweep's duration is off.
};

/// So many seconds of a sensor that counts from its boot and whose clock runs fast by `drift`.
Run run(const Network& network, double drift, int seconds) {
  std::mt19937 random(1);
  std::exponential_distribution<double> delay_ms(1 / network.mean_ms);
  ArrivalClock clock;
  std::vector<double> raw;
  std::vector<double> smoothed;
  double sweep_us = 0;
  std::int64_t came_ns = 0;
  for (int i = 0; i < seconds * 640; ++i) {
    const std::int64_t t = i * kPacket_ns;
    const std::int64_t into_ns = (t + 2 * kSecond) % (5 * kSecond);
    const std::int64_t held_ns = into_ns < network.burst_ns ? network.burst_ns - into_ns : 0;
    const auto delay_ns = kLeast_ns + held_ns + std::llround(delay_ms(random) * 1e6);
    came_ns = std::max<std::int64_t>(came_ns, kUnix_ns + t + delay_ns);
    const auto stamp = [&](std::int64_t time_ns) {
      return 100 * kSecond + time_ns + std::llround(drift * static_cast<double>(time_ns));
    };
    clock.take(stamp(t), came_ns);
    const auto error_us = [&](std::int64_t found_ns) {
      return std::abs(static_cast<double>(found_ns - (kUnix_ns + t + kLeast_ns))) * 1e-3;
    };
    raw.push_back(error_us(came_ns));
    if (i % 64 != 63) continue;
    smoothed.push_back(error_us(clock.arrival_of(stamp(t))));
    const std::int64_t begin_ns = t - 100 * kMs;
    const std::int64_t lasted_ns = clock.arrival_of(stamp(t)) - clock.arrival_of(stamp(begin_ns));
    sweep_us = std::max(sweep_us, std::abs(static_cast<double>(lasted_ns - 100 * kMs)) * 1e-3);
  }
  CHECK(clock.restarts() == 0);
  return {errors_of(raw), errors_of(smoothed), sweep_us};
}

void report(const char* name, const Run& run) {
  std::printf(
      "ARRIVAL | %s | raw %.0f / %.0f / %.0f us | smoothed %.0f / %.0f / %.0f us | a sweep %.1f us |\n", name,
      run.raw.median_us, run.raw.p99_us, run.raw.most_us, run.smoothed.median_us, run.smoothed.p99_us,
      run.smoothed.most_us, run.sweep_us);
}

/// Steady packets without jitter; the stamps of each are moved by `shift`.
void feed(ArrivalClock& clock, std::int64_t from_ns, std::int64_t seconds, std::int64_t stamp_shift_ns,
          std::int64_t arrival_shift_ns = 0) {
  for (std::int64_t t = from_ns; t < from_ns + seconds * kSecond; t += kPacket_ns)
    clock.take(t + stamp_shift_ns, kUnix_ns + t + kLeast_ns + arrival_shift_ns);
}

}  // namespace

TEST_CASE("times by arrival are near the truth on a quiet, a jittery and a bursty network") {
  const Run quiet = run({0.05}, 20e-6, 60);
  const Run jittery = run({1}, 20e-6, 60);
  const Run bursty = run({1, 200 * kMs}, 20e-6, 60);
  const Run wireless = run({5, 400 * kMs}, -50e-6, 60);
  report("wired, exponential 0.05 ms, +20 ppm", quiet);
  report("jittery, exponential 1 ms, +20 ppm", jittery);
  report("... and each 5 s nothing for 200 ms", bursty);
  report("wireless, exponential 5 ms, each 5 s nothing for 400 ms, -50 ppm", wireless);
  CHECK(quiet.smoothed.most_us < 100);
  CHECK(jittery.smoothed.p99_us < 200);
  CHECK(jittery.smoothed.most_us < 1000);
  CHECK(bursty.smoothed.p99_us < 1000);
  CHECK(wireless.smoothed.median_us < 500);
  for (const Run& each : {quiet, jittery, bursty, wireless}) {
    CHECK(each.smoothed.median_us < each.raw.median_us);
    CHECK(each.sweep_us < 20);  // of 0.1 s, with 200 ppm at most
  }
}

TEST_CASE("a sensor that boots again is taken up with its new clock") {
  ArrivalClock clock;
  feed(clock, 0, 20, 100 * kSecond);
  CHECK(clock.arrival_of(110 * kSecond) == kUnix_ns + 10 * kSecond + kLeast_ns);
  feed(clock, 50 * kSecond, 1, -50 * kSecond);
  CHECK(clock.restarts() == 1);
  CHECK(clock.arrival_of(kSecond) == kUnix_ns + 51 * kSecond + kLeast_ns);
}

TEST_CASE("a sensor that finds its master in the middle is taken up, forward by years") {
  ArrivalClock clock;
  feed(clock, 0, 20, 0);
  feed(clock, 20 * kSecond, 1, kUnix_ns);
  CHECK(clock.restarts() == 1);
  CHECK(clock.arrival_of(kUnix_ns + 21 * kSecond) == kUnix_ns + 21 * kSecond + kLeast_ns);
}

TEST_CASE("this machine's clock may be set, forward or back") {
  for (const std::int64_t step_ns : {-10 * kSecond, -kSecond, kSecond, 10 * kSecond}) {
    ArrivalClock clock;
    feed(clock, 0, 20, 0);
    feed(clock, 20 * kSecond, 4, 0, step_ns);
    CHECK(clock.restarts() == 1);
    CHECK(clock.arrival_of(24 * kSecond) == kUnix_ns + 24 * kSecond + kLeast_ns + step_ns);
  }
}

TEST_CASE("stray stamps and a second of silence start nothing anew") {
  ArrivalClock clock;
  feed(clock, 0, 10, 0);
  for (int i = 0; i < 5; ++i) clock.take(kSecond, kUnix_ns + 10 * kSecond);
  feed(clock, 11 * kSecond, 1, 0);
  for (std::int64_t t = 12 * kSecond; t < 13 * kSecond; t += kPacket_ns)
    clock.take(t, kUnix_ns + 13 * kSecond);  // held up, then all at once
  feed(clock, 13 * kSecond, 1, 0);
  CHECK(clock.restarts() == 0);
  CHECK(clock.arrival_of(14 * kSecond) == kUnix_ns + 14 * kSecond + kLeast_ns);
}

TEST_CASE("all times of a sweep are moved by one line") {
  ArrivalClock clock;
  feed(clock, 0, 10, 0);
  Sweep sweep;
  sweep.times_ns = {9 * kSecond, 9 * kSecond + 50 * kMs, 9 * kSecond + 100 * kMs};
  sweep.stamp_ns = 9 * kSecond + 50 * kMs;
  clock.move(sweep);
  CHECK(sweep.stamp_ns == sweep.times_ns[1]);
  CHECK(sweep.times_ns[2] - sweep.times_ns[0] == 100 * kMs);
  CHECK(sweep.times_ns[0] == kUnix_ns + 9 * kSecond + kLeast_ns);
}
