// What has left where it was hit (R11): a walker leaves no trail.
#include <catch2/catch.hpp>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

constexpr std::int64_t kFirst_ns = 1'000'000'000;
const Points kFloor = floor_points(-2, 12, -3, 3);

// `stopped` rays end in each of two voxels above each other in the column (8.25, 0.25), `passed` go through.
Points body(std::size_t stopped, std::size_t passed) {
  Points points;
  for (const double z : {0.75, 1.25}) {
    points = points + Points(stopped, {8.25, 0.25, z});
    points = points + Points(passed, {15.25, 0.25, 1.25 + (z - 1.25) * 15 / 8});
  }
  return points;
}

struct Later {
  int after_ms;
  Points things;
};

std::uint8_t flags(const Points& things, const std::vector<Later>& sweeps) {
  Rig rig;
  rig.see(kFloor + things, kFirst_ns);
  for (const Later& sweep : sweeps) rig.see(kFloor + sweep.things, kFirst_ns + sweep.after_ms * 1'000'000);
  return rig.column(8.25, 0.25).flags;
}

TEST_CASE("What four rays for each that was stopped have passed for 0.18 s has left") {
  CHECK(flags(body(2, 0), {}) == kHard);
  CHECK(flags(body(2, 0), {{90, body(0, 2)}, {180, body(0, 2)}}) == 0);
  CHECK(flags(body(2, 0), {{90, body(0, 2)}, {179, body(0, 2)}}) == kSoft);
  CHECK(flags(body(2, 0), {{90, body(0, 2)}, {180, body(0, 1)}}) == kSoft);
  CHECK(flags(body(2, 0), {{90, body(0, 50)}, {180, body(1, 2)}}) == kSoft);  // is there again
}

TEST_CASE("Of a bush one ray in ten stops, so that more must have passed") {
  CHECK(flags(body(1, 9), {{180, body(0, 39)}}) == kSoft);
  CHECK(flags(body(1, 9), {{180, body(0, 40)}}) == 0);
}

TEST_CASE("What is hit just now in the column beside it stays, unless sixteen for each have passed") {
  const Points beside{{8.25, 0.75, 0.75}, {8.25, 0.75, 1.25}};
  CHECK(flags(body(2, 0), {{200, body(0, 4) + beside}}) != 0);
  CHECK(flags(body(2, 0), {{200, body(0, 15) + beside}}) != 0);
  CHECK(flags(body(2, 0), {{200, body(0, 16) + beside}}) == 0);
  CHECK(flags(body(2, 0), {{200, beside}, {290, body(0, 4)}}) == 0);
}

TEST_CASE("The head that no ray passes has left with the body, a crown that is still hit has not") {
  const Points head(2, {8.25, 0.25, 1.75});
  CHECK(flags(body(2, 0) + head, {{200, body(0, 4)}}) == 0);
  CHECK(flags(body(2, 0) + head, {{200, body(0, 4) + head}}) != 0);
  CHECK(flags(head, {{200, body(0, 4)}}) == kSoft);  // nothing was below
}

TEST_CASE("The rays that stopped where it stood count as passed") {
  Rig rig;
  rig.see(kFloor + body(2, 0), kFirst_ns);
  rig.see(kFloor + body(0, 4) + Points(4, {8.25, 0.25, 1.75}), kFirst_ns + 200'000'000);
  CHECK(rig.column(8.25, 0.25).obstacle_density == 0.25f);  // 4 hits; twice 2 hits and 4 passes
}

}  // namespace
}  // namespace gvom::test
