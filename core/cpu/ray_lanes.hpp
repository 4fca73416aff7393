// Several rays at a time, a lane of a vector for each: how they cross the faces of an axis.
//
// A ray's face crossings of one axis lie at equal distances, so the voxels behind them follow from the other
// two coordinates there, which grow by equal steps: a row of crossings, one of each ray, takes an addition
// for each coordinate and no branch. Neighbouring rays often meet in a voxel, and more often leave the same
// column: these are put together within the row.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/cpu/lanes.hpp"
#include "core/cpu/ray_caster.hpp"
#include "core/lowest_ray.hpp"

namespace gvom::cpu {

/// Coordinates are rounded to 32 bits anew after so many rows.
inline constexpr std::int32_t kBlock = 16;
/// Until then one is off by half a unit at its start, and by half a unit for each of at most 15 steps;
/// doubles before the rounding are far more exact than that.
inline constexpr std::int32_t kTieMargin = 9;
/// With fewer bits below the voxel the margin is wider than the voxel: such rays reach 2^26 voxels.
inline constexpr int kLeastShift = 5;

/// The index of a voxel's counter is x * 64 + y * 8 + z + (y / 8) * next_y + (z / 8) * next_z, which is
/// brick slot * 512 + cell with its terms gathered.
struct CastGrid {
  Int3 size;
  std::int32_t next_y;
  std::int32_t next_z;
  std::int32_t outside;  ///< Counter for what falls out of the grid.
};

/// Where crossings go: counters with the passes to be added, and columns (R5a) with the heights at which they
/// are left. Whole vectors are written; what is too much in one, the next one overwrites.
struct Crossings {
  std::uint32_t* counter;
  std::uint32_t* passes;
  std::uint32_t* column;
  std::int32_t* height;
};

/// Rays from one place, with those crossings of each axis after which its own coordinate is inside of the
/// grid.
template <int kLanes>
struct Rays {
  std::int32_t voxel[3];  // that they start in
  double from[3];         // voxels
  int shift;              // a voxel has 2^shift units; with them all rays fit into 32 bits
  std::int32_t most[3];   // crossings of any ray
  Ints<kLanes> step[3];
  Ints<kLanes> first[3];
  Ints<kLanes> count[3];
  Doubles<kLanes> along[3];  // voxels
};

template <int kLanes>
GVOM_INLINE Ints<kLanes> rounded(Doubles<kLanes> values) {
  return __builtin_convertvector((typename Vectors<kLanes>::Longs)(values + all_doubles<kLanes>(0x1.8p52)),
                                 Ints<kLanes>);
}

template <int kLanes, int kAxis>
class AxisCrossings {
  using Lanes = Ints<kLanes>;
  static constexpr int kB = kAxis == 0 ? 1 : 0;
  static constexpr int kC = kAxis == 2 ? 1 : 2;
  // With four lanes it costs more than it saves.
  static constexpr bool kJoinsNeighbours = kLanes > 4;

 public:
  GVOM_INLINE AxisCrossings(const Rays<kLanes>& rays, const CastGrid& grid)
      : rows_(rays.most[kAxis]),
        units_(all_doubles<kLanes>(1 << rays.shift)),
        from_b_(all_doubles<kLanes>(rays.from[kB])),
        from_c_(all_doubles<kLanes>(rays.from[kC])),
        shift_(all<kLanes>(rays.shift)),
        last_b_(all<kLanes>(grid.size[kB] - 1)),
        last_c_(all<kLanes>(grid.size[kC] - 1)),
        next_y_(all<kLanes>(grid.next_y)),
        next_z_(all<kLanes>(grid.next_z)),
        outside_(all<kLanes>(grid.outside)) {
    using Real = Doubles<kLanes>;
    const Lanes step = rays.step[kAxis], first = rays.first[kAxis];
    const Real towards = __builtin_convertvector(step, Real);
    const Real per_face = towards / rays.along[kAxis];
    const Real to_face = towards * all_doubles<kLanes>(rays.voxel[kAxis] - rays.from[kAxis]) +
                         __builtin_convertvector((step + 1) >> 1, Real);
    slope_b_ = rays.along[kB] * per_face;
    slope_c_ = rays.along[kC] * per_face;
    to_face_ = to_face + __builtin_convertvector(first, Real);
    step_b_ = rounded<kLanes>(slope_b_ * units_);
    step_c_ = rounded<kLanes>(slope_c_ * units_);
    const Real height_one = all_doubles<kLanes>(kHeightOne);
    step_height_ = rounded<kLanes>(slope_c_ * height_one);
    height_ = rounded<kLanes>((from_c_ + slope_c_ * to_face) * height_one) + first * step_height_;
    own_ = rays.voxel[kAxis] + step * first;
    step_ = step;
    enters_ = (own_ | (grid.size[kAxis] - 1 - own_)) >> 31;
    rest_ = rays.count[kAxis] - 1;
  }

  /// Writes all crossings. @return not 0 where one came so near to a face that its side is not known
  GVOM_INLINE Lanes write(Crossings& out) {
    own_part_ = part_of(own_);
    Lanes tie{};
    for (std::int32_t k = 0; k < rows_; k += kBlock) {
      start_block(k);
      for (std::int32_t i = std::min(kBlock, rows_ - k); i > 0; --i) write_row(out, tie);
    }
    return voxel_of(tie);
  }

 private:
  // Both are kTieMargin low.
  GVOM_INLINE void start_block(std::int32_t k) {
    const Doubles<kLanes> faces = to_face_ + all_doubles<kLanes>(k);
    b_ = rounded<kLanes>((from_b_ + slope_b_ * faces) * units_) - kTieMargin;
    c_ = rounded<kLanes>((from_c_ + slope_c_ * faces) * units_) - kTieMargin;
  }

  GVOM_INLINE Lanes voxel_of(Lanes coordinate) const {
    if constexpr (kLanes > 4)
      return coordinate >> shift_;  // a count for each lane, though all are the same: half as long
    else
      return coordinate >> shift_[0];
  }

  // What the own coordinate adds to an index.
  GVOM_INLINE Lanes part_of(Lanes own) const {
    if (kAxis == 0) return own << 6;
    return kAxis == 1 ? part_of_y(own) : part_of_z(own);
  }
  GVOM_INLINE Lanes part_of_y(Lanes y) const { return (y << 3) + (y >> 3) * next_y_; }
  GVOM_INLINE Lanes part_of_z(Lanes z) const { return z + (z >> 3) * next_z_; }

  GVOM_INLINE void write_row(Crossings& out, Lanes& tie) {
    const Lanes before = own_part_;
    own_ += step_;
    own_part_ = part_of(own_);
    const Lanes b = voxel_of(b_), c = voxel_of(c_);
    tie |= (b_ ^ (b_ + 2 * kTieMargin)) | (c_ ^ (c_ + 2 * kTieMargin));
    const Lanes outside = (b | (last_b_ - b) | c | (last_c_ - c) | rest_) >> 31;
    const Lanes part_b = kAxis == 0 ? part_of_y(b) : b << 6;
    const Lanes part_c = kAxis == 2 ? part_of_y(c) : part_of_z(c);
    const Lanes index = own_part_ + part_b + part_c;
    add_passes((index & ~outside) | (outside_ & outside), out);
    if (kAxis < 2) leave((before + part_b) >> 3, outside | enters_, out);
    b_ += step_b_, c_ += step_c_, rest_ -= 1;
  }

  GVOM_INLINE void add_passes(Lanes counter, Crossings& out) {
    if constexpr (kJoinsNeighbours) {
      const Lanes none = all<kLanes>(-1), end = all<kLanes>(kLanes);
      const std::uint32_t starts = unequal<kLanes>(counter, moved_down<kLanes, kLanes - 1>(none, counter));
      const Lanes begin = set_bits<kLanes>(starts);
      store<kLanes>(out.passes, moved_down<kLanes, 1>(begin, end) - begin);
      store<kLanes>(out.counter, picked<kLanes>(counter, begin));
      const int n = __builtin_popcount(starts);
      out.counter += n, out.passes += n;
    } else {
      store<kLanes>(out.passes, all<kLanes>(1));
      store<kLanes>(out.counter, counter);
      out.counter += kLanes, out.passes += kLanes;
    }
  }

  GVOM_INLINE void leave(Lanes column, Lanes outside, Crossings& out) {
    Lanes height = (height_ & ~outside) | (kNoRay & outside);
    height_ += step_height_;
    enters_ = Lanes{};
    if constexpr (kJoinsNeighbours) {
      if constexpr (kLanes > 8) lower<8>(column, height);
      lower<4>(column, height);
      lower<2>(column, height);
      lower<1>(column, height);
      const Lanes before = moved_down<kLanes, kLanes - 1>(all<kLanes>(-1), column);
      const std::uint32_t starts =
          unequal<kLanes>(column, before) & less<kLanes>(height, all<kLanes>(kNoRay));
      const Lanes begin = set_bits<kLanes>(starts);
      store<kLanes>(out.column, picked<kLanes>(column, begin));
      store<kLanes>(out.height, picked<kLanes>(height, begin));
      const int n = __builtin_popcount(starts);
      out.column += n, out.height += n;
    } else {
      store<kLanes>(out.column, column & ~outside);
      store<kLanes>(out.height, height);
      out.column += kLanes, out.height += kLanes;
    }
  }

  // To that of the lane behind that leaves the same column.
  template <int kBy>
  GVOM_INLINE static void lower(Lanes column, Lanes& height) {
    const Lanes other = moved_down<kLanes, kBy>(height, height);
    const Lanes lower = other < height ? other : height;
    height = column == moved_down<kLanes, kBy>(column, column) ? lower : height;
  }

  std::int32_t rows_;
  Doubles<kLanes> units_, from_b_, from_c_;
  Lanes shift_, last_b_, last_c_, next_y_, next_z_, outside_;
  Doubles<kLanes> slope_b_, slope_c_, to_face_;
  Lanes step_b_, step_c_, step_height_, step_;
  Lanes b_, c_, own_, own_part_, height_, rest_, enters_;
};

}  // namespace gvom::cpu
