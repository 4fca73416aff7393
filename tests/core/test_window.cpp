// Which maps the fused map is the sum of (R7), and when its columns were last seen (R15).
#include <catch2/catch.hpp>
#include <cmath>

#include "core/brick_map_storage.hpp"
#include "core/window.hpp"
#include "tests/core/compare.hpp"
#include "tests/core/rig.hpp"
#include "tests/core/window_map.hpp"

namespace gvom::test {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
const Points kPost{{5.25, 0.25, 1.25}};

Window window(int buffer_size, double max_age_s) {
  return Window({buffer_size, max_age_s}, grid_around({}, Eigen::Vector3d::Zero()));
}

std::vector<std::int64_t> stamps(const std::vector<WindowMap>& maps) {
  std::vector<std::int64_t> stamps;
  for (const WindowMap& one : maps) stamps.push_back(one.view.stamp_ns);
  return stamps;
}

using Stamps = std::vector<std::int64_t>;

TEST_CASE("Each lidar keeps its last maps") {
  Window w = window(2, 10);
  for (const std::int64_t stamp_ns : {1, 2, 3}) REQUIRE(w.add(map(0, stamp_ns)) == AddResult::added);
  CHECK(stamps(w.maps()) == Stamps{3, 2});
  CHECK(stamps(w.left()) == Stamps{1});
  REQUIRE(w.add(map(1, 0)) == AddResult::added);  // another lidar's is not displaced
  CHECK(stamps(w.maps()) == Stamps{3, 2, 0});
  CHECK(w.left().empty());
  CHECK(w.count(0) == 2);
  CHECK(w.count(1) == 1);
}

TEST_CASE("A map of exactly the maximum age stays, an older one leaves") {
  Window w = window(8, 2.0);
  w.add(map(0, 0));
  w.add(map(1, 1));
  REQUIRE(w.add(map(0, 2 * kSecond_ns)) == AddResult::added);
  CHECK(stamps(w.maps()) == Stamps{2 * kSecond_ns, 1, 0});
  REQUIRE(w.add(map(0, 2 * kSecond_ns + 1)) == AddResult::added);
  CHECK(stamps(w.left()) == Stamps{0});
  CHECK(w.add(map(1, 0)) == AddResult::too_old);
}

TEST_CASE("A late map takes its place, if it has one") {
  Window w = window(2, 10);
  w.add(map(0, 10));
  w.add(map(0, 30));
  CHECK(w.add(map(0, 5)) == AddResult::too_old);
  REQUIRE(w.add(map(0, 20)) == AddResult::added);
  CHECK(stamps(w.maps()) == Stamps{30, 20});
  CHECK(stamps(w.left()) == Stamps{10});
}

TEST_CASE("A map that is there already is refused and nothing changes") {
  Window w = window(2, 10);
  w.add(map(0, 10));
  CHECK(w.add(map(0, 10)) == AddResult::duplicate);
  CHECK(w.add(map(1, 10)) == AddResult::added);  // equal stamps of two lidars are two maps
  CHECK(w.maps().size() == 2);
}

TEST_CASE("Of maps with one stamp the lower lidar comes first, whichever came first") {
  Window w = window(2, 10);
  w.add(map(1, 10));
  w.add(map(0, 10));
  CHECK(w.maps().front().lidar == 0);
  CHECK(w.maps().back().lidar == 1);
}

TEST_CASE("A map of another shape is refused") {
  Window w = window(2, 10);
  WindowMap other = map(0, 10);
  other.view.grid.size[2] += 8;
  CHECK(w.add(other) == AddResult::wrong_grid);
  other = map(0, 10);
  other.view.grid.resolution_m[0] = 0.2;
  CHECK(w.add(other) == AddResult::wrong_grid);
  CHECK(w.maps().empty());
}

TEST_CASE("A cleared window hands all its maps back") {
  Window w = window(2, 10);
  w.add(map(0, 10));
  w.add(map(1, 20));
  w.clear();
  CHECK(w.maps().empty());
  CHECK(stamps(w.left()) == Stamps{20, 10});
  CHECK(w.add(map(0, 1)) == AddResult::added);
}

TEST_CASE("Hits and passes are summed over the window, passes of free voxels too") {
  Rig rig;
  rig.see(kPost, 1 * kSecond_ns);
  rig.see({{8.25, 0.25, 1.25}}, 2 * kSecond_ns);  // over where the post was
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 1);
  CHECK(rig.voxel(5.25, 0.25, 1.25).passes == 1);
  CHECK(rig.voxel(2.25, 0.25, 1.25).passes == 2);
  CHECK(rig.voxel(8.25, 0.25, 1.25).hits == 1);
}

TEST_CASE("What left the window has left the map, and the lowest return is again that of the others") {
  MapperConfig config = half_metre_map();
  config.window = {2, 100};
  Rig rig(config);
  rig.see({{5.25, 0.25, 1.05}}, 1 * kSecond_ns);
  rig.see({{5.25, 0.25, 1.35}}, 2 * kSecond_ns);
  CHECK(rig.voxel(5.25, 0.25, 1.25).min_height_m == 1.05f);
  rig.see({{5.25, 0.25, 1.45}}, 3 * kSecond_ns);
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 2);
  CHECK(rig.voxel(5.25, 0.25, 1.25).min_height_m == 1.35f);
  rig.see({{9.25, 5.25, 1.25}}, 200 * kSecond_ns);  // alone in the window by age
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 0);
  CHECK(rig.total().hits == 1);
}

TEST_CASE("What went out of the grid comes back with it while its map is in the window") {
  Rig rig;
  rig.see(kPost, 1'000'000'000);
  rig.see({{1000.25, 0.25, 1.25}}, 1'100'000'000, {1000, 0, 0});
  CHECK(rig.total().hits == 1);
  rig.see({{6.25, 0.25, 1.25}}, 1'200'000'000);
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 1);
  CHECK(rig.voxel(5.25, 0.25, 1.25).passes == 1);
}

TEST_CASE("The order in which maps come changes nothing") {
  Rig in_order, late;
  const Points a = floor_points(-5, 5, -5, 5), b = kPost, c{{7.25, 3.25, 0.25}};
  in_order.see(a, 1'000'000'000), in_order.see(b, 1'100'000'000, {3, 0, 0}),
      in_order.see(c, 1'200'000'000, {9, 1, 2});
  late.see(c, 1'200'000'000, {9, 1, 2}), late.see(a, 1'000'000'000), late.see(b, 1'100'000'000, {3, 0, 0});
  CHECK(in_order.fuser().moment().grid.origin == late.fuser().moment().grid.origin);
  CHECK(in_order.total().hits == late.total().hits);
  for (double x = -1.75; x < 12; x += 0.5)
    for (double y = -4.75; y < 5; y += 0.5) {
      const ColumnValues one = in_order.column(x, y), other = late.column(x, y);
      REQUIRE((one.height == other.height || (std::isnan(one.height) && std::isnan(other.height))));
      REQUIRE(one.cost == other.cost);
      REQUIRE(one.flags == other.flags);
      REQUIRE(
          (one.last_seen == other.last_seen || (std::isnan(one.last_seen) && std::isnan(other.last_seen))));
    }
}

TEST_CASE("A column was last seen by the newest map that hit or passed it") {
  Rig rig;
  rig.see({{5.25, 0.25, 1.25}}, 1'000'000'000);
  rig.see({{3.25, 0.25, 1.25}}, 2'500'000'000);
  CHECK(rig.column(5.25, 0.25).last_seen == 1.5f);
  CHECK(rig.column(4.25, 0.25).last_seen == 1.5f);  // passed only
  CHECK(rig.column(3.25, 0.25).last_seen == 0.0f);
  CHECK(rig.column(0.25, 0.25).last_seen == 0.0f);
  CHECK(std::isnan(rig.column(5.25, 3.25).last_seen));
  rig.see({{0.75, 0.25, 1.25}}, 4'000'000'000);  // the first map is too old now
  CHECK(std::isnan(rig.column(5.25, 0.25).last_seen));
  CHECK(rig.column(3.25, 0.25).last_seen == 1.5f);
}

}  // namespace
}  // namespace gvom::test
