// Random drives on the CPU give the oracle's bits.
#include <catch2/catch.hpp>

#include "tests/core/race.hpp"

namespace gvom::test {
namespace {

TEST_CASE("Random drives through the smallest grid give the oracle's bits") {
  race(Backend::cpu, {8, 8, 40, 60, false}, 100, seed_count(100));
  race(Backend::cpu, {8, 8, 40, 60, true}, 200, seed_count(100));
}

TEST_CASE("Random drives through a flat grid give the oracle's bits") {
  CHECK(race(Backend::cpu, {64, 8, 30, 150, false}, 300, 8) == kAllFlags);
  race(Backend::cpu, {64, 8, 30, 150, true}, 400, seed_count(8));
}

TEST_CASE("Random drives through a cube give the oracle's bits") {
  CHECK(race(Backend::cpu, {64, 64, 24, 250, false}, 500, 6) == kAllFlags);
  race(Backend::cpu, {64, 64, 24, 250, true}, 600, seed_count(6));
}

TEST_CASE("Random drives through a tower of two mask words give the oracle's bits") {
  race(Backend::cpu, {8, 128, 30, 80, false}, 700, seed_count(6));
  race(Backend::cpu, {8, 128, 30, 80, true}, 800, seed_count(6));
  race(Backend::cpu, {64, 128, 20, 200, false}, 900, 3);
}

TEST_CASE("Random drives through a grid that is no power of two give the oracle's bits") {
  race(Backend::cpu, {264, 8, 20, 400, false}, 1000, seed_count(3));
  race(Backend::cpu, {264, 64, 20, 400, true}, 1100, 1);
  race(Backend::cpu, {24, 72, 30, 150, false}, 1200, seed_count(6));
}

TEST_CASE("Random drives with a memory give the oracle's bits") {
  race(Backend::cpu, {8, 8, 60, 60, false, 3}, 3000, seed_count(30));
  race(Backend::cpu, {24, 72, 60, 150, false, 4}, 3100, seed_count(6));
  CHECK(race(Backend::cpu, {64, 64, 40, 250, false, 3}, 3200, 6) == kAllFlags);
  race(Backend::cpu, {64, 64, 40, 250, true, 3}, 3300, seed_count(4));
}

TEST_CASE("Random drives with a memory of many seconds give the oracle's bits") {
  race(Backend::cpu, {8, 8, 60, 60, true, 20, 700'000'000}, 3400, seed_count(30));
  race(Backend::cpu, {64, 8, 60, 150, false, 30, 700'000'000}, 3500, seed_count(8));
  race(Backend::cpu, {64, 64, 40, 250, false, 60, 3'000'000'000}, 3600, seed_count(4));
}

}  // namespace
}  // namespace gvom::test
