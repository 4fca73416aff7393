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

}  // namespace
}  // namespace gvom::test
