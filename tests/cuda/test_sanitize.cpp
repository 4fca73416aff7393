// A little of everything, for compute-sanitizer: under it each kernel takes a hundred times as long.
#include <catch2/catch.hpp>

#include "tests/core/race.hpp"
#include "tests/cuda/drive.hpp"
#include "tests/cuda/gpu.hpp"
#include "tests/cuda/twins.hpp"

namespace gvom::test {
namespace {

TEST_CASE("CUDA: random drives, shared memory, steady ticks") {
  if (!has_gpu()) return;
  race(Backend::cuda, {24, 72, 12, 100, false}, 1200, 4);
  CHECK(run_twins({64, 32, 10, 300, false}, 7001).added > 0);
  const auto drive = Drive::open(Backend::cuda).value();
  for (int i = 0; i < 20; ++i) REQUIRE(drive->step());
  CHECK(drive->costs()->launches == 14);
}

}  // namespace
}  // namespace gvom::test
