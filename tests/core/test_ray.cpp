// The walk of a ray (R5, R5a): against the oracle's sorted crossings, and against geometry.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "core/lowest_ray.hpp"
#include "tests/core/random.hpp"
#include "tests/oracle/ray.hpp"

namespace gvom::test {
namespace {

struct FixedRay {
  std::int64_t from[3];
  std::int64_t to[3];

  FixedRay(const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
    for (int a = 0; a < 3; ++a) {
      from[a] = to_fixed(start[a], 0);
      to[a] = to_fixed(end[a], 0);
    }
  }
};

std::vector<Int3> walk(const FixedRay& ray) {
  std::vector<Int3> voxels;
  walk_ray(ray.from, ray.to, [&](int x, int y, int z) {
    voxels.push_back({x, y, z});
    return true;
  });
  return voxels;
}

// Voxels from -40 to 40; a third of the rays from and to whole or half ones.
Eigen::Vector3d random_point(Random& random) {
  const int most = random.pick({1, 5, 40});
  Eigen::Vector3d p;
  for (int a = 0; a < 3; ++a)
    p[a] = random.chance(0.4) ? random.integer(-2 * most, 2 * most) * 0.5 : random.uniform(-most, most);
  return p;
}

bool are_neighbours(const Int3& a, const Int3& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) == 1;
}

// Whether the segment goes through a voxel grown by `margin` on all sides.
bool goes_through(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const Int3& voxel,
                  double margin) {
  double enter = 0, leave = 1;
  for (int a = 0; a < 3; ++a) {
    const double low = voxel[std::size_t(a)] - margin - start[a], high = low + 1 + 2 * margin;
    const double along = end[a] - start[a];
    if (along == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / along, high / along));
    leave = std::min(leave, std::max(low / along, high / along));
  }
  return enter <= leave;
}

// Where the ray leaves columns, as the product's own walk says.
std::vector<ColumnLeft> columns_left(const FixedRay& ray) {
  std::vector<ColumnLeft> left;
  RayHeights heights(ray.from, ray.to);
  walk_ray(
      ray.from, ray.to, [](int, int, int) { return true; },
      [&](int axis, int x, int y, int) {
        if (axis < 2) left.push_back(heights.leave(axis, x, y));
      });
  return left;
}

// Whether the ray is that high, to 2 mm of a voxel of 0.4 m, somewhere on the way out of the column.
bool is_height_on_the_way(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const ColumnLeft& left) {
  const double z = left.height / kHeightOne;
  double nearest = 1e9;
  for (int a = 0; a < 2; ++a) {
    const double along = end[a] - start[a];
    if (along == 0) continue;
    const double face = (a == 0 ? left.x : left.y) + (along > 0 ? 1 : 0);
    nearest = std::min(nearest, std::abs(start.z() + (face - start[a]) / along * (end.z() - start.z()) - z));
  }
  return nearest < 0.005;
}

TEST_CASE("A fixed coordinate keeps its voxel, also below zero and on faces") {
  CHECK(fixed_voxel(to_fixed(3.0, 0)) == 3);
  CHECK(fixed_voxel(to_fixed(std::nextafter(3.0, 0.0), 0)) == 2);
  CHECK(fixed_voxel(to_fixed(-3.0, 0)) == -3);
  CHECK(fixed_voxel(to_fixed(std::nextafter(-3.0, -4.0), 0)) == -4);
  CHECK(fixed_voxel(to_fixed(-0.0, 0)) == 0);
  CHECK(fixed_voxel(to_fixed(-1e-300, 0)) == -1);
  CHECK(fixed_voxel(to_fixed(1e9 + 0.5, 999'999'992)) == 8);
}

TEST_CASE("A straight ray goes through every voxel before its end") {
  CHECK(walk({{0.5, 0.5, 0.5}, {3.5, 0.5, 0.5}}) == std::vector<Int3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  CHECK(walk({{0.5, 0.5, 0.5}, {0.5, -1.5, 0.5}}) == std::vector<Int3>{{0, 0, 0}, {0, -1, 0}});
  CHECK(walk({{0.5, 0.5, 0.5}, {0.9, 0.1, 0.5}}).empty());
}

TEST_CASE("A ray through corners crosses x before y before z") {
  CHECK(walk({{0.5, 0.5, 0.5}, {2.5, 2.5, 2.5}}) ==
        std::vector<Int3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}, {2, 2, 1}});
  CHECK(walk({{0.5, 0.5, 0.5}, {0.5, 2.5, 2.5}}) ==
        std::vector<Int3>{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 2, 1}});
}

TEST_CASE("A flat ray crosses where it should") {
  // It is at y = 1 where x = 3.5.
  CHECK(walk({{0.5, 0.25, 0.5}, {4.5, 1.25, 0.5}}) ==
        std::vector<Int3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}});
}

TEST_CASE("Random rays take the same way as the oracle's, and it is theirs") {
  Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d start = random_point(random), end = random_point(random);
    const FixedRay ray(start, end);
    std::vector<Int3> voxels = walk(ray);
    INFO("ray " << i << " from " << start.transpose() << " to " << end.transpose());
    REQUIRE(voxels == oracle::voxels_before_end(ray.from, ray.to));
    voxels.push_back({fixed_voxel(ray.to[0]), fixed_voxel(ray.to[1]), fixed_voxel(ray.to[2])});
    REQUIRE(voxels.front() ==
            Int3{fixed_voxel(ray.from[0]), fixed_voxel(ray.from[1]), fixed_voxel(ray.from[2])});
    bool connected = true, on_the_way = true;
    for (std::size_t v = 1; v < voxels.size(); ++v) connected &= are_neighbours(voxels[v - 1], voxels[v]);
    for (const Int3& voxel : voxels) on_the_way &= goes_through(start, end, voxel, 1e-6);
    REQUIRE(connected);
    REQUIRE(on_the_way);
  }
}

TEST_CASE("Random rays leave columns where the oracle's do, at their height to 2 mm") {
  Random random(8);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d start = random_point(random), end = random_point(random);
    const FixedRay ray(start, end);
    const std::vector<ColumnLeft> left = columns_left(ray);
    const std::vector<oracle::Departure> expected = oracle::departures(ray.from, ray.to);
    INFO("ray " << i << " from " << start.transpose() << " to " << end.transpose());
    REQUIRE(left.size() == expected.size());
    bool same = true, on_the_way = true;
    for (std::size_t k = 0; k < left.size(); ++k) {
      same &= left[k].x == expected[k].from[0] && left[k].y == expected[k].from[1];
      same &= left[k].height == expected[k].height;
      on_the_way &= is_height_on_the_way(start, end, left[k]);
    }
    REQUIRE(same);
    REQUIRE(on_the_way);
  }
}

}  // namespace
}  // namespace gvom::test
