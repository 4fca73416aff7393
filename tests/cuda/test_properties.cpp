// Random drives on the CUDA back end give the oracle's bits: 1,000 sweeps and more of several lidars, with
// windows that slide and grids that move. On a GPU, or on the fake device.
#include <catch2/catch.hpp>

#include "tests/core/race.hpp"
#include "tests/cuda/gpu.hpp"

namespace gvom::test {
namespace {

TEST_CASE("CUDA: random drives through the smallest grid give the oracle's bits") {
  if (!has_gpu()) return;
  race(Backend::cuda, {8, 8, 40, 60, false}, 2100, seed_count(25));
  race(Backend::cuda, {8, 8, 40, 60, true}, 2200, seed_count(25));
}

TEST_CASE("CUDA: random drives through a flat grid and a cube give the oracle's bits") {
  if (!has_gpu()) return;
  CHECK(race(Backend::cuda, {64, 8, 30, 150, false}, 300, 8) == kAllFlags);
  race(Backend::cuda, {64, 64, 24, 250, false}, 2500, 2);
  race(Backend::cuda, {64, 64, 24, 250, true}, 2600, 2);
}

TEST_CASE("CUDA: random drives through towers and odd grids give the oracle's bits") {
  if (!has_gpu()) return;
  race(Backend::cuda, {8, 128, 30, 80, false}, 2700, 6);
  race(Backend::cuda, {64, 128, 20, 200, false}, 900, 3);
  race(Backend::cuda, {264, 8, 20, 400, false}, 1000, seed_count(3));
  race(Backend::cuda, {24, 72, 30, 150, true}, 1200, seed_count(6));
}

TEST_CASE("CUDA: random drives with a memory give the oracle's bits") {
  if (!has_gpu()) return;
  race(Backend::cuda, {8, 8, 60, 60, false, 3}, 3000, seed_count(10));
  race(Backend::cuda, {24, 72, 60, 150, false, 4}, 3100, seed_count(3));
  race(Backend::cuda, {64, 64, 40, 250, false, 3}, 3200, 2);
  race(Backend::cuda, {8, 8, 60, 60, true, 20, 700'000'000}, 3400, seed_count(10));
  race(Backend::cuda, {64, 8, 60, 150, false, 30, 700'000'000}, 3500, seed_count(3));
  race(Backend::cuda, {64, 64, 40, 250, false, 60, 3'000'000'000}, 3600, 2);
}

}  // namespace
}  // namespace gvom::test
