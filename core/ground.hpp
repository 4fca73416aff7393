// The ground of a column (R9), for host and device.
//
// What a column's lowest return hit is its ground, unless rays went below it: then it hangs there, a crown or
// a branch, and the ground is what the columns around it say. What stands on the ground, a bush or a rock, is
// higher than the ground on both sides of it.
#pragma once

#include "core/column_grid.hpp"

namespace gvom {

/// A lowest return hangs if a ray left its column this far below it, metres.
inline constexpr float kHangs_m = 0.3F;
/// A ray this far below the lowest return, but not that far, was on ground between blades or stones.
inline constexpr float kBlades_m = 0.1F;

/// Ground stands out if it is higher than the ground on both sides, at one of `kSides` columns, by this much
/// and by what the curvature of ground allows.
inline constexpr double kStandsOut_m = 0.1;
inline constexpr double kCurvature_per_m = 0.08;  ///< Of the square of the distance.
inline constexpr std::int32_t kSides = 8;

/// A rim is no higher than ground around it, up to `kConeReach` columns along x and y, would let it be.
inline constexpr double kConeSlope = 0.6;  ///< m/m along an axis; over the diagonal 1.4 times that.
inline constexpr float kCone_m = 0.1F;
inline constexpr std::int32_t kConeReach = 6;

/// Ground is doubtful if it is over the cones of the ground around by so much more, metres, or where less
/// than a fifth of the ground in the columns of the cone's reach is rims.
inline constexpr float kTowers_m = 1.2F;
inline constexpr std::int8_t kRimVote = 4;  ///< Against that of other ground.
inline constexpr std::int8_t kOtherVote = -1;

/// Doubtful ground is a face if three columns in a row bend by no more, metres, on all lines that have them,
/// and so many have.
inline constexpr float kBend_m = 1.0F;
inline constexpr std::int32_t kFaceLines = 3;

/// How a column's ground is to that around it: bits of a byte.
enum Standing : std::uint8_t { kStandsOut = 1, kDoubtful = 2 };

/// The four lines through a column: along x, y and the diagonals.
inline constexpr std::int32_t kLines = 4;
GVOM_HD inline std::int32_t line_offset(const ColumnGrid& grid, std::int32_t line) {
  return line == 0 ? 1 : line == 1 ? grid.pitch() : line == 2 ? grid.pitch() + 1 : 1 - grid.pitch();
}

/// How much ground may bend between columns `distance` off on both sides, metres.
GVOM_HD inline double curved_rise_m(std::int32_t line, std::int32_t distance, double resolution_m) {
  return kCurvature_per_m * ((distance * resolution_m) * (distance * resolution_m) * (line < 2 ? 1 : 2));
}

/// How much higher than the ground `distance` columns off on both sides ground may be.
GVOM_HD inline float allowed_rise_m(std::int32_t line, std::int32_t distance, double resolution_m) {
  return static_cast<float>(kStandsOut_m + curved_rise_m(line, distance, resolution_m));
}

/// Whether known ground of height `z_m` is higher by more than `allowed_m` than both; an unknown one is
/// higher.
GVOM_HD inline bool rises_over(float z_m, float one_m, float other_m, float allowed_m) {
  const float limit_m = (one_m > other_m ? one_m : other_m) + allowed_m;
  return (static_cast<int>(z_m > limit_m) & static_cast<int>(z_m < kNone_m)) != 0;
}

/// Height of the cone over ground `distance` columns off along an axis.
GVOM_HD inline float cone_rise_m(std::int32_t distance, double resolution_m) {
  return static_cast<float>(kConeSlope * (distance * resolution_m));
}

GVOM_HD inline float lower_of(float a_m, float b_m) {
  return b_m < a_m ? b_m : a_m;
}

/// Whether ground is one by which holes and hidden ground are judged. @param cone_m the lowest cone over the
/// ground around and itself
GVOM_HD inline bool is_rim(float ground_m, float cone_m, bool stands_out) {
  return (static_cast<int>(ground_m <= cone_m + kCone_m) & static_cast<int>(ground_m < kNone_m) &
          static_cast<int>(!stands_out)) != 0;
}

/// Whether known ground towers over some ground around. @param cone_m as in `is_rim`
GVOM_HD inline bool towers(float ground_m, float cone_m) {
  return (static_cast<int>(ground_m > cone_m + kTowers_m) & static_cast<int>(ground_m < kNone_m)) != 0;
}

/// Of a column in the vote on whether ground is doubtful where it is.
GVOM_HD inline std::int8_t rim_vote(float ground_m, bool is_rim) {
  return static_cast<std::int8_t>(is_rim ? kRimVote : ground_m < kNone_m ? kOtherVote : 0);
}

/// Columns from `at` to the nearest rim along `step`, 1 .. `kSides`; more if there is none.
GVOM_HD inline std::int32_t distance_to_rim(const GroundView& view, std::int32_t at, std::int32_t step) {
  std::int32_t distance = 1;
  while (distance <= kSides && view.is_rim[at + distance * step] == 0) ++distance;
  return distance;
}

/// Whether the cone of one of the nearest rims, both ways along the lines, reaches a column's ground.
GVOM_HD inline bool is_carried(const GroundView& view, std::int32_t at, double resolution_m) {
  for (std::int32_t line = 0; line < kLines; ++line)
    for (std::int32_t way = -1; way <= 1; way += 2) {
      const std::int32_t step = way * line_offset(view.grid, line);
      const std::int32_t distance = distance_to_rim(view, at, step);
      if (distance > kSides) continue;
      const float rise_m = cone_rise_m(distance, resolution_m);
      const float along_m = view.ground_m[at + distance * step] + rise_m;
      if (view.ground_m[at] <= (line < 2 ? along_m : along_m + rise_m) + kCone_m) return true;
    }
  return false;
}

/// By how much the grounds of three columns in a row bend, metres: of this one and the next ones along a
/// line, or, at the edge of what is known, the next two on one side. kNone_m where three are not known.
GVOM_HD inline float bend_m(const GroundView& view, std::int32_t at, std::int32_t step) {
  const float before_m = view.ground_m[at - step], after_m = view.ground_m[at + step];
  std::int32_t middle = at;
  if (before_m == kNone_m) middle = at + step;
  if (after_m == kNone_m) middle = at - step;
  const float one_m = view.ground_m[middle - step], other_m = view.ground_m[middle + step];
  const float middle_m = view.ground_m[middle];
  if (one_m == kNone_m || middle_m == kNone_m || other_m == kNone_m) return kNone_m;
  return std::fabs((one_m + other_m) - 2 * middle_m);
}

/// Whether ground goes on around a column as it does on a steep face, and foliage does not.
GVOM_HD inline bool is_face(const GroundView& view, std::int32_t at) {
  std::int32_t lines = 0;
  for (std::int32_t line = 0; line < kLines; ++line) {
    const float by_m = bend_m(view, at, line_offset(view.grid, line));
    if (by_m == kNone_m) continue;
    if (by_m > kBend_m) return false;
    ++lines;
  }
  return lines >= kFaceLines;
}

/// What the rims around a column say that its ground is: on each line through it that has a rim on both
/// sides, the height between them, weighted by 1 / (their distance)^2; kNone_m if no line has. `at` indexes
/// the view.
GVOM_HD inline float ground_between_rims(const GroundView& view, std::int32_t at) {
  double weights = 0, heights = 0;
  for (std::int32_t line = 0; line < kLines; ++line) {
    const std::int32_t step = line_offset(view.grid, line);
    const std::int32_t before = distance_to_rim(view, at, -step);
    if (before > kSides) continue;
    const std::int32_t after = distance_to_rim(view, at, step);
    if (after > kSides) continue;
    const double length = before + after;
    const double weight = 1 / (length * length * (line < 2 ? 1 : 2));
    const auto z_before = static_cast<double>(view.ground_m[at - before * step]);
    const auto z_after = static_cast<double>(view.ground_m[at + after * step]);
    weights += weight;
    heights += weight * ((z_before * after + z_after * before) / length);
  }
  return weights > 0 ? static_cast<float>(heights / weights) : kNone_m;
}

}  // namespace gvom
