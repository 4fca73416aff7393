#include "core/cpu/ray_caster.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"
#include "core/lowest_ray.hpp"

// A ray's face crossings of one axis lie at equal distances, so the voxels behind them are computed
// several at a time without a branch, from the other two coordinates there. Where one of these comes so
// near to a face that 32 bits cannot tell the sides, the ray is walked exactly instead: the result is that
// of `walk_ray`, always.

namespace gvom::cpu {

namespace {

// Numbers that are computed together: as many as the instruction set takes at once, at most 16.
template <int kLanes>
struct Vectors {
  typedef std::int32_t Ints __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
  typedef std::uint32_t Unsigneds __attribute__((vector_size(kLanes * sizeof(std::uint32_t))));
};
constexpr int kMostLanes = 16;

// A lane's coordinate is a rounded start (off by half a unit) plus at most 15 rounded steps (off by half
// a unit each); doubles before the rounding are far more exact than that.
constexpr std::uint32_t kTieMargin = 9;
// With fewer bits below the voxel the margin is wider than the voxel: such rays reach 2^26 voxels.
constexpr int kLeastShift = 5;

// The index of a voxel's counter is x * 64 + y * 8 + z + (y / 8) * next_y + (z / 8) * next_z, which is
// brick slot * 512 + cell with its terms gathered.
struct CastGrid {
  Int3 size;
  std::uint32_t next_y;
  std::uint32_t next_z;
  std::uint32_t outside;         // counter for what falls out of the grid
  std::uint32_t outside_column;  // column for the same
};

// Where the crossings of a batch go. Those of x and y faces also say something of a column (R5a).
struct Crossings {
  std::uint32_t* counter;
  std::uint32_t* column;
  std::int32_t* height;
};

// A ray with those crossings of each axis after which its own coordinate is inside of the grid.
struct Ray {
  std::int32_t voxel[3];
  std::int32_t step[3];
  std::int32_t first[3];
  std::int32_t count[3];
  double from[3];   // voxels
  double along[3];  // voxels
  int shift;        // a voxel has 2^shift units; with them the whole ray fits into 32 bits
  double units;     // 2^shift
};

// 0, 1, 2, ..
template <class Ints>
GVOM_INLINE Ints ascending() {
  Ints lanes{};
  for (std::size_t i = 0; i < sizeof(Ints) / sizeof lanes[0]; ++i) lanes[i] = static_cast<std::int32_t>(i);
  return lanes;
}

// Conditions are sign bits: comparisons of whole vectors are not vector instructions everywhere.
template <class Ints>
GVOM_INLINE bool any_negative(Ints value) {
  std::int32_t any = 0;
  for (std::size_t i = 0; i < sizeof(Ints) / sizeof any; ++i) any |= value[i];
  return any < 0;
}

// Negative where a coordinate is less than kTieMargin units from a face.
template <int kLanes>
GVOM_INLINE typename Vectors<kLanes>::Ints near_a_face(typename Vectors<kLanes>::Ints coordinate, int shift) {
  using V = Vectors<kLanes>;
  const std::uint32_t margin = kTieMargin << (32 - shift);
  const auto fraction = (typename V::Unsigneds)coordinate << (32 - shift);
  return (typename V::Ints)(((fraction + margin) >> 1) - margin);
}

// Writes what lies behind the crossings of an axis in whole vectors; negative lanes had a tie.
template <int kLanes, int kAxis>
GVOM_INLINE typename Vectors<kLanes>::Ints crossings_of_axis(const Ray& ray, const CastGrid& grid,
                                                             const Crossings& out) {
  using Ints = typename Vectors<kLanes>::Ints;
  using Unsigneds = typename Vectors<kLanes>::Unsigneds;
  constexpr int kB = kAxis == 0 ? 1 : 0;
  constexpr int kC = kAxis == 2 ? 1 : 2;
  const std::int32_t step = ray.step[kAxis];
  const double units_per_voxel = ray.units * step / ray.along[kAxis];
  const double step_b = ray.along[kB] * units_per_voxel;
  const double step_c = ray.along[kC] * units_per_voxel;
  const double to_face = step * (ray.voxel[kAxis] - ray.from[kAxis]) + (step > 0 ? 1 : 0) + ray.first[kAxis];
  const double from_b = ray.from[kB] * ray.units;
  const double from_c = ray.from[kC] * ray.units;
  const Ints ramp = ascending<Ints>();
  const Unsigneds ramp_b = (Unsigneds)ramp * round_to_32_bits(step_b);
  const Unsigneds ramp_c = (Unsigneds)ramp * round_to_32_bits(step_c);
  Ints own = ray.voxel[kAxis] + step * (ray.first[kAxis] + 1) + step * ramp;
  const FaceHeights heights =
      kAxis < 2 ? face_heights(from_c + step_c * (to_face - ray.first[kAxis]), step_c, ray.units)
                : FaceHeights{};
  const Unsigneds ramp_height = (Unsigneds)ramp * heights.step;
  const std::uint32_t next_left = grid.next_y / kBrickEdge;
  Ints tie{};
  for (std::int32_t k = 0; k < ray.count[kAxis]; k += kLanes) {
    const Ints b = (Ints)(ramp_b + round_to_32_bits(from_b + step_b * (to_face + k)));
    const Ints c = (Ints)(ramp_c + round_to_32_bits(from_c + step_c * (to_face + k)));
    const Ints voxel_b = b >> ray.shift;
    const Ints voxel_c = c >> ray.shift;
    tie |= near_a_face<kLanes>(b, ray.shift) | near_a_face<kLanes>(c, ray.shift);
    const Ints x = kAxis == 0 ? own : voxel_b;
    const Ints y = kAxis == 1 ? own : (kAxis == 0 ? voxel_b : voxel_c);
    const Ints z = kAxis == 2 ? own : voxel_c;
    const Unsigneds index_xy = (Unsigneds)((x << 6) + (y << 3)) + (Unsigneds)(y >> 3) * grid.next_y;
    const Unsigneds index = index_xy + (Unsigneds)z + (Unsigneds)(z >> 3) * grid.next_z;
    const Ints excess = voxel_b | (grid.size[kB] - 1 - voxel_b) | voxel_c | (grid.size[kC] - 1 - voxel_c) |
                        (ray.count[kAxis] - 1 - k - ramp);
    const auto out_of_grid = (Unsigneds)(excess >> 31);
    const Unsigneds counter = (index & ~out_of_grid) | (grid.outside & out_of_grid);
    __builtin_memcpy(out.counter + k, &counter, sizeof counter);
    if (kAxis < 2) {
      const Ints left_y = y - step;
      const Unsigneds left = kAxis == 0
                                 ? (index_xy >> 3) - step * kBrickEdge
                                 : (Unsigneds)((x << 3) + left_y) + (Unsigneds)(left_y >> 3) * next_left;
      const Unsigneds column = (left & ~out_of_grid) | (grid.outside_column & out_of_grid);
      const Unsigneds height = ramp_height + (heights.first + (ray.first[kAxis] + k) * heights.step);
      __builtin_memcpy(out.column + k, &column, sizeof column);
      __builtin_memcpy(out.height + k, &height, sizeof height);
    }
    own += step * kLanes;
  }
  return tie;
}

GVOM_INLINE Ray make_ray(const std::int64_t (&from)[3], const RayEnds& ends, int i, const Int3& size) {
  Ray ray;
  std::int32_t reach = 1;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t to = ends.to[a][i];
    const std::int32_t v = fixed_voxel(from[a]);
    const std::int32_t end = fixed_voxel(to);
    const bool forward = to >= from[a];
    const std::int32_t n = size[a];
    ray.voxel[a] = v;
    ray.step[a] = forward ? 1 : -1;
    ray.first[a] = std::max(0, forward ? -v - 1 : v - n);
    const std::int32_t last = std::min(forward ? end - v : v - end, forward ? n - 1 - v : v);
    ray.count[a] = std::max(0, last - ray.first[a]);
    ray.from[a] = static_cast<double>(from[a]) / static_cast<double>(kFixedOne);
    ray.along[a] = static_cast<double>(to - from[a]) / static_cast<double>(kFixedOne);
    reach |= (v ^ (v >> 31)) | (end ^ (end >> 31));
  }
  ray.shift = __builtin_clz(static_cast<std::uint32_t>(reach)) - 1;
  ray.units = static_cast<double>(1 << ray.shift);
  return ray;
}

struct Crossed {
  std::size_t faces_xy = 0;
  std::size_t faces_z = 0;
  int ties = 0;
  std::uint8_t tie[kRayBatch];  // rays that must be walked exactly
};

// Where it starts outside of the grid, its first crossing leaves no column of it.
GVOM_INLINE bool needs_exact_walk(const Ray& ray) {
  return ray.shift < kLeastShift || ray.first[0] > 0 || ray.first[1] > 0;
}

// Fills `xy` and `z` with what lies behind all crossings of all rays, but for those in `tie`. Each axis
// writes whole vectors; what it writes too much, the next one overwrites.
template <int kLanes>
GVOM_INLINE Crossed cross_with_lanes(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                                     const Crossings& xy, const Crossings& z) {
  Crossed crossed;
  const auto from_on = [](const Crossings& all, std::size_t at) {
    return Crossings{all.counter + at, all.column + at, all.height + at};
  };
  for (int i = 0; i < ends.count; ++i) {
    const Ray ray = make_ray(from, ends, i, grid.size);
    if (needs_exact_walk(ray)) {
      crossed.tie[crossed.ties++] = static_cast<std::uint8_t>(i);
      continue;
    }
    const Crossings of_x = from_on(xy, crossed.faces_xy);
    const Crossings of_y = from_on(of_x, static_cast<std::size_t>(ray.count[0]));
    const Crossings of_z{z.counter + crossed.faces_z, nullptr, nullptr};
    typename Vectors<kLanes>::Ints tie = crossings_of_axis<kLanes, 0>(ray, grid, of_x);
    tie |= crossings_of_axis<kLanes, 1>(ray, grid, of_y);
    tie |= crossings_of_axis<kLanes, 2>(ray, grid, of_z);
    if (any_negative(tie)) {
      crossed.tie[crossed.ties++] = static_cast<std::uint8_t>(i);
      continue;
    }
    crossed.faces_xy += static_cast<std::size_t>(ray.count[0] + ray.count[1]);
    crossed.faces_z += static_cast<std::size_t>(ray.count[2]);
  }
  return crossed;
}

#ifdef GVOM_CLONE_FOR
GVOM_CLONE_FOR("arch=x86-64-v4")
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& xy, const Crossings& z) {
  return cross_with_lanes<16>(from, ends, grid, xy, z);
}

GVOM_CLONE_FOR("arch=x86-64-v3")
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& xy, const Crossings& z) {
  return cross_with_lanes<8>(from, ends, grid, xy, z);
}
#endif

GVOM_CLONE_DEFAULT
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& xy, const Crossings& z) {
  return cross_with_lanes<4>(from, ends, grid, xy, z);
}

}  // namespace

PassCounters::PassCounters(const Grid& grid)
    : size_(grid.size),
      bricks_(grid.bricks()),
      counters_((std::size_t{grid.brick_slots()} + 1) * kBrickCells),
      touched_(std::size_t{grid.brick_slots()} + 1),
      lowest_(std::size_t{grid.columns()} + 1, kNoRay),
      crossed_xy_(kRayBatch * (static_cast<std::size_t>(size_[0]) + size_[1]) + kMostLanes),
      crossed_z_(kRayBatch * static_cast<std::size_t>(size_[2]) + kMostLanes),
      crossed_column_(crossed_xy_.size()),
      crossed_height_(crossed_xy_.size()) {}

void PassCounters::cast_exactly(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
  RayHeights heights(from, to);
  walk_ray(
      from, to,
      [this](std::int32_t x, std::int32_t y, std::int32_t z) {
        const std::uint32_t i = index(x, y, z);
        ++counters_[i];
        touched_[i >> 9] = 1;
        return true;
      },
      [&](int axis, std::int32_t x, std::int32_t y, std::int32_t z) {
        if (axis == 2) return;
        const ColumnLeft left = heights.leave(axis, x, y);
        if (inside(x, y, z)) lower_to(column(left.x, left.y), left.height);
      });
}

void PassCounters::count(const std::vector<std::uint32_t>& counters, std::size_t crossings) {
  for (std::size_t i = 0; i < crossings; ++i) {
    ++counters_[counters[i]];
    touched_[counters[i] >> 9] = 1;
  }
}

void PassCounters::cast(const std::int64_t (&from)[3], const RayEnds& ends) {
  const auto next_y = static_cast<std::uint32_t>(bricks_[0] * kBrickCells - 64);
  const auto next_z = static_cast<std::uint32_t>(bricks_[0] * bricks_[1] * kBrickCells - 8);
  const CastGrid grid{size_, next_y, next_z, outside(), outside_column()};
  const Crossings xy{crossed_xy_.data(), crossed_column_.data(), crossed_height_.data()};
  const Crossed crossed = cross_faces(from, ends, grid, xy, {crossed_z_.data(), nullptr, nullptr});
  count(crossed_xy_, crossed.faces_xy);
  count(crossed_z_, crossed.faces_z);
  for (std::size_t i = 0; i < crossed.faces_xy; ++i) lower_to(crossed_column_[i], crossed_height_[i]);
  const std::uint32_t start = index(fixed_voxel(from[0]), fixed_voxel(from[1]), fixed_voxel(from[2]));
  counters_[start] += static_cast<std::uint32_t>(ends.count - crossed.ties);
  touched_[start >> 9] = 1;
  for (int t = 0; t < crossed.ties; ++t) {
    const int i = crossed.tie[t];
    cast_exactly(from, {ends.to[0][i], ends.to[1][i], ends.to[2][i]});
    ++counters_[ends.counter[i]];
  }
  // The last crossing of every ray led into its end's own voxel.
  for (int i = 0; i < ends.count; ++i) --counters_[ends.counter[i]];
}

}  // namespace gvom::cpu
