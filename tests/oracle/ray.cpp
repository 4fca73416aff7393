#include "tests/oracle/ray.hpp"

#include <algorithm>
#include <cmath>

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

std::vector<Crossing> crossings_in_order(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  std::vector<Crossing> crossings;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t low = std::min(from[a], to[a]), high = std::max(from[a], to[a]);
    for (std::int64_t face = voxel_of(low) + 1; face <= voxel_of(high); ++face)
      crossings.push_back({a, std::abs(face * kFixedOne - from[a]), high - low});
  }
  std::sort(crossings.begin(), crossings.end(), comes_first);
  return crossings;
}

// Calls `visit(crossing, voxel before it, voxel behind it)`.
template <class Visit>
void walk(const std::int64_t (&from)[3], const std::int64_t (&to)[3], Visit&& visit) {
  Int3 voxel;
  for (std::size_t a = 0; a < 3; ++a) voxel[a] = static_cast<std::int32_t>(voxel_of(from[a]));
  for (const Crossing& crossing : crossings_in_order(from, to)) {
    const Int3 before = voxel;
    const auto a = static_cast<std::size_t>(crossing.axis);
    voxel[a] += to[a] > from[a] ? 1 : -1;
    visit(crossing, before, voxel);
  }
}

// Heights where a ray crosses the faces of an axis: rounded at the first face and from face to face.
class Heights {
 public:
  Heights(std::int64_t from_z, std::int64_t to_z)
      : from_(in_voxels(from_z)), rise_(in_voxels(to_z - from_z)) {}

  std::int64_t at_next(const Crossing& crossing) {
    const double slope = rise_ * (1 / in_voxels(crossing.length));
    if (crossed_++ == 0) return first_ = units(from_ + slope * in_voxels(crossing.distance));
    return first_ + (crossed_ - 1) * units(slope);
  }

 private:
  static double in_voxels(std::int64_t fixed) {
    return static_cast<double>(fixed) / static_cast<double>(kFixedOne);
  }
  // The nearest whole number; of two the even one.
  static std::int64_t units(double voxels) { return std::llrint(65536 * voxels); }

  double from_, rise_;
  std::int64_t crossed_ = 0, first_ = 0;
};

}  // namespace

std::vector<Int3> voxels_before_end(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  std::vector<Int3> voxels;
  walk(from, to, [&](const Crossing&, const Int3& before, const Int3&) { voxels.push_back(before); });
  return voxels;
}

std::vector<Departure> departures(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  Heights heights[2] = {{from[2], to[2]}, {from[2], to[2]}};
  std::vector<Departure> departures;
  walk(from, to, [&](const Crossing& crossing, const Int3& before, const Int3& behind) {
    if (crossing.axis < 2) departures.push_back({before, behind, heights[crossing.axis].at_next(crossing)});
  });
  return departures;
}

}  // namespace gvom::oracle
