// Which lidars Layers names as missing: by the stamps of the maps in the window.
#include <catch2/catch.hpp>

#include "core/grid.hpp"
#include "services/fusion/missing.hpp"
#include "tests/core/window_map.hpp"

using namespace gvom;
using fusion::is_missing;
using test::map;

namespace {

constexpr std::int64_t kTenth_ns = 100'000'000;
constexpr std::int64_t kAfter_ns = 300'000'000;

Window window() {
  return Window({8, 2.0}, grid_around({}, Eigen::Vector3d::Zero()));
}

}  // namespace

TEST_CASE(
    "a lidar that dies is missing within half a second of its last map, and there again with its next") {
  Window w = window();
  for (int i = 0; i <= 10; ++i) {  // both at 10 Hz, the second half a period later; it dies after 0.15 s
    w.add(map(0, i * kTenth_ns));
    if (i < 2) w.add(map(1, i * kTenth_ns + kTenth_ns / 2));
    CHECK_FALSE(is_missing(w, 0, kAfter_ns));
    if (i > 0) CHECK(is_missing(w, 1, kAfter_ns) == (i > 4));  // the map of 0.4 s is 0.25 s newer: not more
  }
  CHECK(w.count(1) == 2);  // its maps are still of use
  w.add(map(1, 10 * kTenth_ns + kTenth_ns / 2));
  CHECK_FALSE(is_missing(w, 1, kAfter_ns));
}

TEST_CASE("a lidar of which the window has nothing is missing") {
  Window w = window();
  CHECK(is_missing(w, 0, kAfter_ns));
  w.add(map(0, 0));
  CHECK_FALSE(is_missing(w, 0, kAfter_ns));
  CHECK(is_missing(w, 1, kAfter_ns));
  w.clear();
  CHECK(is_missing(w, 0, kAfter_ns));
}

TEST_CASE("when all lidars fall silent at once none is missing: the layers grow old") {
  Window w = window();
  w.add(map(0, 0));
  w.add(map(1, kTenth_ns));
  CHECK_FALSE(is_missing(w, 0, kAfter_ns));
  CHECK_FALSE(is_missing(w, 1, kAfter_ns));
}
