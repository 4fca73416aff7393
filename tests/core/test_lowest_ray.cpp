// How low rays have been in a column (R5a), in one map and over the window.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

constexpr std::int64_t kTenth_ns = 100'000'000;
// From the sensor at (0.25, 0.25, 1.25) rays to these fall 0.2 and 0.1 m a metre.
const Points kSteep{{5.25, 0.25, 0.25}};
const Points kFlat{{5.25, 0.25, 0.75}};

auto height(double m) {
  return Approx(m).margin(1e-4);
}

MapperConfig two_maps() {
  MapperConfig config = half_metre_map();
  config.window = {2, 10};
  return config;
}

TEST_CASE("A ray that falls a metre in five leaves each column 0.1 m lower") {
  Rig rig;
  rig.see(kSteep);
  for (int i = 0; i < 10; ++i) CHECK(rig.lowest_ray_m(0.25 + 0.5 * i, 0.25) == height(1.2 - 0.1 * i));
}

TEST_CASE("The column in which a ray ends, those behind it and beside it say nothing") {
  Rig rig;
  rig.see(kSteep);
  CHECK(std::isinf(rig.lowest_ray_m(5.25, 0.25)));
  CHECK(std::isinf(rig.lowest_ray_m(5.75, 0.25)));
  CHECK(std::isinf(rig.lowest_ray_m(2.25, 0.75)));
}

TEST_CASE("A ray straight down leaves no column") {
  Rig rig;
  rig.see({{0.25, 0.25, -4.25}});
  CHECK(rig.voxel(0.25, 0.25, 0.25).passes == 1);
  CHECK(std::isinf(rig.lowest_ray_m(0.25, 0.25)));
}

TEST_CASE("A ray that rises is lowest where it leaves, too: what is known is where it went out") {
  Rig rig;
  rig.see({{0.25, -4.75, 2.25}});
  CHECK(rig.lowest_ray_m(0.25, 0.25) == height(1.25 + 0.2 * 0.25));
  CHECK(rig.lowest_ray_m(0.25, -0.25) == height(1.25 + 0.2 * 0.75));
}

TEST_CASE("A slanted ray leaves columns over x and over y faces") {
  Rig rig;
  rig.see({{4.25, 2.25, 0.25}});  // falls 0.25 m for each metre of x, y grows by half of x
  CHECK(rig.lowest_ray_m(0.25, 0.25) == height(1.25 - 0.25 * 0.25));
  CHECK(rig.lowest_ray_m(0.75, 0.25) == height(1.25 - 0.25 * 0.5));  // over y = 0.5, at x = 0.75
  CHECK(rig.lowest_ray_m(0.75, 0.75) == height(1.25 - 0.25 * 0.75));
}

TEST_CASE("A ray that leaves the grid says nothing of the column at the edge") {
  Rig rig;
  rig.see({{40.25, 0.25, 1.25}});  // the grid reaches from -16 to 16 m
  CHECK(rig.lowest_ray_m(15.25, 0.25) == height(1.25));
  CHECK(std::isinf(rig.lowest_ray_m(15.75, 0.25)));
}

TEST_CASE("Of several rays in a column the lowest counts, in whatever order") {
  for (const Points& points : {kSteep + kFlat, kFlat + kSteep}) {
    Rig rig;
    rig.see(points);
    CHECK(rig.lowest_ray_m(2.25, 0.25) == height(1.25 - 0.2 * 2.25));
  }
}

TEST_CASE("Of two maps the lowest ray counts; when one leaves, the other's comes back") {
  Rig rig(two_maps());
  rig.see(kSteep, kTenth_ns);
  rig.see(kFlat, 2 * kTenth_ns);
  CHECK(rig.lowest_ray_m(2.25, 0.25) == height(1.25 - 0.2 * 2.25));
  rig.see({{0.25, 5.25, 1.25}}, 3 * kTenth_ns);
  CHECK(rig.lowest_ray_m(2.25, 0.25) == height(1.25 - 0.1 * 2.25));
  rig.see({{0.25, 5.25, 1.25}}, 4 * kTenth_ns);
  CHECK(std::isinf(rig.lowest_ray_m(2.25, 0.25)));
}

TEST_CASE("When the grid moves, columns keep what they know and those that enter know nothing") {
  Rig rig(two_maps());
  rig.see(kSteep, kTenth_ns);
  rig.see({{16.25, 0.25, -2.25}}, 2 * kTenth_ns, {16, 0, 0});  // from 0 to 32 m now, seen straight down
  CHECK(rig.lowest_ray_m(4.25, 0.25) == height(1.25 - 0.2 * 4.25));
  CHECK(std::isinf(rig.lowest_ray_m(20.25, 0.25)));
  rig.see({{0.25, 0.25, -2.25}}, 3 * kTenth_ns);  // and back: the steep ray's map has left
  CHECK(std::isinf(rig.lowest_ray_m(4.25, 0.25)));
}

TEST_CASE("After a reset nothing is known") {
  Rig rig;
  rig.see(kSteep, kTenth_ns);
  rig.reset();
  rig.see({{0.25, 0.25, -2.25}}, 2 * kTenth_ns);
  CHECK(std::isinf(rig.lowest_ray_m(2.25, 0.25)));
}

}  // namespace
}  // namespace gvom::test
