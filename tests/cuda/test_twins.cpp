// The CUDA back end gives the bytes of the CPU, through shared memory as on the bus.
#include <catch2/catch.hpp>

#include "tests/cuda/gpu.hpp"
#include "tests/cuda/twins.hpp"

namespace gvom::test {
namespace {

TEST_CASE("CPU and CUDA give the same bytes of every map, layer and voxel") {
  if (!has_gpu()) return;
  TwinTally total;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const bool large = seed % 6 == 0;
    const TwinTally tally =
        run_twins({large ? 256 : 64, large ? 64 : 32, 30, large ? 4000 : 500, seed % 5 == 0}, 5000 + seed);
    total.added += tally.added;
    total.layers += tally.layers;
  }
  CHECK(total.added > 500);
  CHECK(total.layers > 200);
}

// As `sweep`, long after all others, from where the vehicle then was.
void add_after_gap(Scenario& scenario, const Arrival& arrival) {
  constexpr std::int64_t kGap_ns = 2'000'000'000'000;
  StampedPose pose = scenario.odometry.back();
  pose.stamp_ns += kGap_ns;
  Arrival late = arrival;
  const std::int64_t shift_ns = pose.stamp_ns - late.sweep.stamp_ns;
  late.sweep.stamp_ns += shift_ns;
  for (std::int64_t& time_ns : late.sweep.times_ns) time_ns += shift_ns;
  for (std::int64_t before_ns = 200'000'000; before_ns >= 0; before_ns -= 100'000'000)
    scenario.odometry.push_back({pose.stamp_ns - before_ns, pose.T_odom_base});
  scenario.arrivals.push_back(late);
}

TEST_CASE(
    "CPU and CUDA agree on windows of more maps than a warp has lanes, and when all of them leave at once") {
  if (!has_gpu()) return;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    Scenario scenario = random_scenario(9000 + seed, {64, 32, 120, 150, false});
    scenario.config.window = {90, 1000};
    add_after_gap(scenario, scenario.arrivals.front());
    const TwinTally tally = run_scenario_twins(scenario, seed);
    CHECK(tally.most_maps > 32);
    CHECK(tally.most_left > 32);
  }
}

}  // namespace
}  // namespace gvom::test
