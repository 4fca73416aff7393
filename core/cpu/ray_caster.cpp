#include "core/cpu/ray_caster.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"
#include "core/ray.hpp"

// A ray's face crossings of one axis lie at equal distances, so the voxels behind them are computed
// eight at a time without a branch, from the other two coordinates there. Where one of these comes so
// near to a face that doubles cannot tell the sides (kTieMargin), the ray is walked exactly instead:
// the result is that of `walk_ray`, always.

namespace gvom::cpu {

namespace {

constexpr int kLanes = 8;
using Doubles = double __attribute__((vector_size(kLanes * sizeof(double))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
using Unsigneds = std::uint32_t __attribute__((vector_size(kLanes * sizeof(std::uint32_t))));
using Longs = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

// Added to a coordinate below 2^19 voxels, this leaves it in the low bits of the double's mantissa, as
// a fixed-point number with 32 bits below the voxel.
constexpr double kMantissa = 0x1.8p20;
// In units of 2^-32 voxels: rounding to that is the largest error of a coordinate.
constexpr std::uint32_t kTieMargin = 1;

// The index of a voxel's counter is x * 64 + y * 8 + z + (y / 8) * next_y + (z / 8) * next_z, which is
// brick slot * 512 + cell with its terms gathered.
struct CastGrid {
  Int3 size;
  std::int32_t next_y;
  std::int32_t next_z;
  std::int32_t outside;  // counter for what falls out of the grid
};

struct Ray {
  std::int32_t voxel[3];
  std::int32_t step[3];
  std::int32_t crossings[3];
  double from[3];
  double along[3];
};

GVOM_INLINE std::int64_t bits_of(double value) {
  std::int64_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

GVOM_INLINE Ints near_a_face(Ints fraction) {
  return (Ints)((Unsigneds)fraction + kTieMargin <= Unsigneds{} + 2 * kTieMargin);
}

template <int kAxis, bool kClip>
GVOM_INLINE void crossings_of_axis(const Ray& ray, const CastGrid& grid, std::int32_t first,
                                   std::int32_t count, std::uint32_t* out, std::uint8_t* touched, Ints& tie) {
  constexpr int kB = kAxis == 0 ? 1 : 0;
  constexpr int kC = kAxis == 2 ? 1 : 2;
  const double step = ray.step[kAxis];
  const double per_voxel = 1 / ray.along[kAxis];
  const double slope_b = ray.along[kB] * per_voxel;
  const double slope_c = ray.along[kC] * per_voxel;
  const double to_face = ray.voxel[kAxis] + (step > 0 ? 1 : 0) + step * first - ray.from[kAxis];
  const Doubles ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  const Ints int_ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  Doubles distance = to_face + step * ramp;
  Ints own = ray.voxel[kAxis] + ray.step[kAxis] * (first + 1) + ray.step[kAxis] * int_ramp;
  const Longs zero = std::int64_t{0} + bits_of(kMantissa) - Longs{};
  // A brick is entered through one of its own faces: by one of eight neighbouring crossings.
  const std::int32_t entry = (ray.step[kAxis] > 0 ? -own[0] : own[0] + 1) & 7;
  for (std::int32_t k = 0; k < count; k += kLanes) {
    const Longs b = (Longs)((ray.from[kB] + slope_b * distance) + kMantissa) - zero;
    const Longs c = (Longs)((ray.from[kC] + slope_c * distance) + kMantissa) - zero;
    const Ints voxel_b = __builtin_convertvector(b >> 32, Ints);
    const Ints voxel_c = __builtin_convertvector(c >> 32, Ints);
    tie |= near_a_face(__builtin_convertvector(b, Ints)) | near_a_face(__builtin_convertvector(c, Ints));
    const Ints x = kAxis == 0 ? own : voxel_b;
    const Ints y = kAxis == 1 ? own : (kAxis == 0 ? voxel_b : voxel_c);
    const Ints z = kAxis == 2 ? own : voxel_c;
    Ints index = (x << 6) + (y << 3) + z + (y >> 3) * grid.next_y + (z >> 3) * grid.next_z;
    if (kClip) {
      const Ints in = (Ints)((Unsigneds)voxel_b < Unsigneds{} + static_cast<std::uint32_t>(grid.size[kB])) &
                      (Ints)((Unsigneds)voxel_c < Unsigneds{} + static_cast<std::uint32_t>(grid.size[kC]));
      index = (index & in) | (grid.outside & ~in);
    }
    __builtin_memcpy(out + k, &index, sizeof index);
    distance += step * kLanes;
    own += ray.step[kAxis] * kLanes;
  }
  for (std::int32_t k = entry; k < count; k += kBrickEdge) touched[out[k] >> 9] = 1;
}

// The crossings of each axis after which its own coordinate is inside of the grid.
struct Crossings {
  std::int32_t first[3];
  std::int32_t count[3];
};

GVOM_INLINE Crossings clip_to_grid(const Ray& ray, const CastGrid& grid) {
  Crossings clipped;
  for (int a = 0; a < 3; ++a) {
    const std::int32_t v = ray.voxel[a];
    const std::int32_t n = grid.size[a];
    clipped.first[a] = std::max(0, ray.step[a] > 0 ? -v - 1 : v - n);
    const std::int32_t end = std::min(ray.crossings[a], ray.step[a] > 0 ? n - 1 - v : v);
    clipped.count[a] = std::max(0, end - clipped.first[a]);
  }
  return clipped;
}

// Fills `out` with the counters behind all crossings; false if the ray has to be walked exactly. Each
// axis writes whole vectors; what it writes too much, the next one overwrites.
template <bool kClip>
GVOM_INLINE bool all_axes(const Ray& ray, const CastGrid& grid, const Crossings& c, std::uint32_t* out,
                          std::uint8_t* touched) {
  Ints tie{};
  crossings_of_axis<0, kClip>(ray, grid, c.first[0], c.count[0], out, touched, tie);
  crossings_of_axis<1, kClip>(ray, grid, c.first[1], c.count[1], out + c.count[0], touched, tie);
  crossings_of_axis<2, kClip>(ray, grid, c.first[2], c.count[2], out + c.count[0] + c.count[1], touched, tie);
  std::int32_t any = 0;
  for (int i = 0; i < kLanes; ++i) any |= tie[i];
  return any == 0;
}

GVOM_CLONES bool crossings_inside(const Ray& ray, const CastGrid& grid, const Crossings& c,
                                  std::uint32_t* out, std::uint8_t* touched) {
  return all_axes<false>(ray, grid, c, out, touched);
}

GVOM_CLONES bool crossings_clipped(const Ray& ray, const CastGrid& grid, const Crossings& c,
                                   std::uint32_t* out, std::uint8_t* touched) {
  return all_axes<true>(ray, grid, c, out, touched);
}

}  // namespace

PassCounters::PassCounters(const Grid& grid)
    : size_(grid.size),
      bricks_(grid.bricks()),
      counters_((std::size_t{grid.brick_slots()} + 1) * kBrickCells),
      touched_(std::size_t{grid.brick_slots()} + 1),
      crossed_(static_cast<std::size_t>(size_[0]) + size_[1] + size_[2] + kLanes) {}

void PassCounters::cast_exactly(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  walk_ray(from, to, [this](std::int32_t x, std::int32_t y, std::int32_t z) {
    if (!inside(x, y, z)) return;
    const std::uint32_t i = index(x, y, z);
    ++counters_[i];
    touched_[i >> 9] = 1;
  });
}

void PassCounters::cast(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  Ray ray;
  std::int32_t end[3];
  for (int a = 0; a < 3; ++a) {
    ray.voxel[a] = fixed_voxel(from[a]);
    end[a] = fixed_voxel(to[a]);
    ray.step[a] = to[a] >= from[a] ? 1 : -1;
    ray.crossings[a] = ray.step[a] * (end[a] - ray.voxel[a]);
    ray.from[a] = static_cast<double>(from[a]) / static_cast<double>(kFixedOne);
    ray.along[a] = static_cast<double>(to[a] - from[a]) / static_cast<double>(kFixedOne);
  }
  const CastGrid grid{size_, bricks_[0] * kBrickCells - 64, bricks_[0] * bricks_[1] * kBrickCells - 8,
                      static_cast<std::int32_t>(counters_.size() - kBrickCells)};
  const Crossings clipped = clip_to_grid(ray, grid);
  const bool starts_inside = inside(ray.voxel[0], ray.voxel[1], ray.voxel[2]);
  const bool ends_inside = inside(end[0], end[1], end[2]);
  const auto& crossings = starts_inside && ends_inside ? crossings_inside : crossings_clipped;
  if (!crossings(ray, grid, clipped, crossed_.data(), touched_.data())) return cast_exactly(from, to);

  const std::int32_t count = clipped.count[0] + clipped.count[1] + clipped.count[2];
  for (std::int32_t k = 0; k < count; ++k) ++counters_[crossed_[k]];
  if (starts_inside) {
    const std::uint32_t start = index(ray.voxel[0], ray.voxel[1], ray.voxel[2]);
    ++counters_[start];
    touched_[start >> 9] = 1;
  }
  if (ends_inside) --counters_[index(end[0], end[1], end[2])];
}

}  // namespace gvom::cpu
