#include "tests/oracle/ray.hpp"

#include <algorithm>

#include "core/ray.hpp"

namespace gvom::oracle {

namespace {

// Where the ray goes through a face: `distance / length` of its way.
struct Crossing {
  int axis;
  std::int64_t distance;
  std::int64_t length;
};

bool comes_first(const Crossing& a, const Crossing& b) {
  const __int128 left = static_cast<__int128>(a.distance) * b.length;
  const __int128 right = static_cast<__int128>(b.distance) * a.length;
  return left != right ? left < right : a.axis < b.axis;
}

// The voxel that holds a coordinate. Fixed coordinates are odd, so none lies on a face.
std::int64_t voxel_of(std::int64_t fixed) {
  const std::int64_t towards_zero = fixed / kFixedOne;
  return fixed < 0 ? towards_zero - 1 : towards_zero;
}

}  // namespace

std::vector<Int3> voxels_before_end(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  std::vector<Crossing> crossings;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t low = std::min(from[a], to[a]), high = std::max(from[a], to[a]);
    for (std::int64_t face = voxel_of(low) + 1; face <= voxel_of(high); ++face)
      crossings.push_back({a, std::abs(face * kFixedOne - from[a]), high - low});
  }
  std::sort(crossings.begin(), crossings.end(), comes_first);
  Int3 voxel;
  for (std::size_t a = 0; a < 3; ++a) voxel[a] = static_cast<std::int32_t>(voxel_of(from[a]));
  std::vector<Int3> voxels;
  for (const Crossing& crossing : crossings) {
    voxels.push_back(voxel);
    const auto a = static_cast<std::size_t>(crossing.axis);
    voxel[a] += to[a] > from[a] ? 1 : -1;
  }
  return voxels;
}

}  // namespace gvom::oracle
