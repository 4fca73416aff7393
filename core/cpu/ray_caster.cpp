#include "core/cpu/ray_caster.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"
#include "core/cpu/ray_lanes.hpp"
#include "core/lowest_ray.hpp"

// Rays are taken several at a time (core/cpu/ray_lanes.hpp). Where one of them comes so near to a face that
// 32 bits cannot tell the sides, they are walked exactly instead: the result is that of `walk_ray`, always.

namespace gvom::cpu {

namespace {

struct Crossed {
  std::size_t crossings = 0;
  std::size_t columns = 0;
  int ties = 0;
  std::uint8_t tie[kRayBatch];  // rays that must be walked exactly
};

// Lanes without a ray end where they start.
template <int kLanes>
GVOM_INLINE void make_axis(Rays<kLanes>& rays, int a, std::int64_t from, const std::int64_t* ends, int count,
                           std::int32_t size, std::int32_t& reach) {
  const std::int32_t v = fixed_voxel(from);
  const std::int32_t ahead = size - 1 - v;
  std::int32_t step[kLanes], first[kLanes], crossings[kLanes];
  double along[kLanes];
  std::int32_t most = 0, reached = v ^ (v >> 31);
  for (int i = 0; i < kLanes; ++i) {
    const std::int64_t to = i < count ? ends[i] : from;
    const std::int32_t end = fixed_voxel(to);
    const std::int32_t forward = to >= from ? 1 : 0;
    step[i] = 2 * forward - 1;
    first[i] = std::max(0, forward ? -v - 1 : -ahead - 1);
    crossings[i] = std::max(0, std::min(step[i] * (end - v), forward ? ahead : v) - first[i]);
    along[i] = static_cast<double>(to - from) * (1 / static_cast<double>(kFixedOne));
    most = std::max(most, crossings[i]);
    reached |= end ^ (end >> 31);
  }
  rays.voxel[a] = v;
  rays.from[a] = static_cast<double>(from) / static_cast<double>(kFixedOne);
  rays.most[a] = most;
  __builtin_memcpy(&rays.step[a], step, sizeof step);
  __builtin_memcpy(&rays.first[a], first, sizeof first);
  __builtin_memcpy(&rays.count[a], crossings, sizeof crossings);
  __builtin_memcpy(&rays.along[a], along, sizeof along);
  reach |= reached;
}

template <int kLanes>
GVOM_INLINE Rays<kLanes> make_rays(const std::int64_t (&from)[3], const RayEnds& ends, int first,
                                   const Int3& size) {
  Rays<kLanes> rays;
  std::int32_t reach = 1;
  for (int a = 0; a < 3; ++a)
    make_axis(rays, a, from[a], ends.to[a] + first, ends.count - first, size[static_cast<std::size_t>(a)],
              reach);
  rays.shift = __builtin_clz(static_cast<std::uint32_t>(reach)) - 1;
  return rays;
}

template <int kLanes>
GVOM_INLINE Crossed cross_with_lanes(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                                     const Crossings& rows) {
  Crossed crossed;
  Crossings next = rows;
  for (int first = 0; first < ends.count; first += kLanes) {
    const Rays<kLanes> rays = make_rays<kLanes>(from, ends, first, grid.size);
    Crossings out = next;
    if (rays.shift >= kLeastShift) {
      auto tie = AxisCrossings<kLanes, 0>(rays, grid).write(out);
      tie |= AxisCrossings<kLanes, 1>(rays, grid).write(out);
      tie |= AxisCrossings<kLanes, 2>(rays, grid).write(out);
      if (!any_set<kLanes>(tie)) {
        next = out;
        continue;
      }
    }
    for (int i = first; i < std::min(first + kLanes, ends.count); ++i)
      crossed.tie[crossed.ties++] = static_cast<std::uint8_t>(i);
  }
  crossed.crossings = static_cast<std::size_t>(next.counter - rows.counter);
  crossed.columns = static_cast<std::size_t>(next.column - rows.column);
  return crossed;
}

#ifdef GVOM_CLONE_FOR
GVOM_CLONE_FOR("arch=x86-64-v4")
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& rows) {
  return cross_with_lanes<16>(from, ends, grid, rows);
}

GVOM_CLONE_FOR("arch=x86-64-v3")
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& rows) {
  return cross_with_lanes<8>(from, ends, grid, rows);
}
#endif

GVOM_CLONE_DEFAULT
Crossed cross_faces(const std::int64_t (&from)[3], const RayEnds& ends, const CastGrid& grid,
                    const Crossings& rows) {
  return cross_with_lanes<4>(from, ends, grid, rows);
}

}  // namespace

PassCounters::PassCounters(const Grid& grid)
    : size_(grid.size),
      bricks_(grid.bricks()),
      counters_((std::size_t{grid.brick_slots()} + 1) * kBrickCells),
      touched_(std::size_t{grid.brick_slots()} + 1),
      lowest_(std::size_t{grid.columns()} + 1, kNoRay),
      crossed_(kRayBatch * (static_cast<std::size_t>(size_[0]) + size_[1] + size_[2]) + kMostLanes),
      crossed_passes_(crossed_.size()),
      crossed_column_(crossed_.size()),
      crossed_height_(crossed_.size()) {}

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

void PassCounters::cast(const std::int64_t (&from)[3], const RayEnds& ends) {
  const auto next_y = static_cast<std::int32_t>(bricks_[0] * kBrickCells - 64);
  const auto next_z = static_cast<std::int32_t>(bricks_[0] * bricks_[1] * kBrickCells - 8);
  const CastGrid grid{size_, next_y, next_z, static_cast<std::int32_t>(outside())};
  const Crossed crossed =
      cross_faces(from, ends, grid,
                  {crossed_.data(), crossed_passes_.data(), crossed_column_.data(), crossed_height_.data()});
  std::uint32_t* const counters = counters_.data();
  std::uint8_t* const touched = touched_.data();
  for (std::size_t i = 0; i < crossed.crossings; ++i) {
    counters[crossed_[i]] += crossed_passes_[i];
    touched[crossed_[i] >> 9] = 1;
  }
  for (std::size_t i = 0; i < crossed.columns; ++i) lower_to(crossed_column_[i], crossed_height_[i]);
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
