// Negative obstacles (R13), for host and device: a hole is where a ray has been below the ground that should
// be there, by what the ground on this side of it and beyond it says.
#pragma once

#include "core/column_bits.hpp"
#include "core/sight_line.hpp"

namespace gvom {

/// Rims of so many steps, at least, say how ground goes on: of fewer, two groups far apart lie on one line
/// whatever they are.
inline constexpr std::int32_t kLeastSteps = 4;

/// Least-squares line through rims, heights relative to one of them, over steps from that one on.
struct RimLine {
  std::int32_t n = 0, k = 0, kk = 0;
  double z = 0, kz = 0, zz = 0;
  std::int32_t steps = 0;  ///< That have a rim.

  GVOM_HD void add(std::int32_t step, double height_m) {
    n += 1, k += step, kk += step * step;
    z += height_m, kz += step * height_m, zz += height_m * height_m;
  }
};

struct RimFit {
  double at_first_m;      ///< Height where the line begins, relative.
  double slope_per_step;  ///< Metres.
  double rms_m;
  bool defined;
};

GVOM_HD inline RimFit solve_rims(const RimLine& s) {
  if (s.steps < kLeastSteps) return {0, 0, 0, false};
  const std::int32_t determinant = s.n * s.kk - s.k * s.k;
  const double slope = (s.n * s.kz - s.k * s.z) / determinant;
  const double first = (s.z - slope * s.k) / s.n;
  const double squares = (s.zz - first * s.z) - slope * s.kz;
  return {first, slope, std::sqrt(squares > 0 ? squares / s.n : 0), true};
}

/// Seen ground shows a pit if it is lower than the rims on both sides, 1 .. `kPitSides` columns off on a
/// line, by this share of `negative_threshold` and by what the curvature of ground allows.
inline constexpr std::int32_t kPitSides = 3;
inline constexpr double kPitShare = 0.3;

/// By how much at least, metres: of one configuration.
struct PitDepths {
  float least_m[kLines][kPitSides];  ///< From a distance of 1 on.
};

GVOM_HD inline PitDepths pit_depths(double resolution_m, double negative_threshold_m) {
  PitDepths depths{};
  for (std::int32_t line = 0; line < kLines; ++line)
    for (std::int32_t d = 1; d <= kPitSides; ++d)
      depths.least_m[line][d - 1] =
          static_cast<float>(kPitShare * negative_threshold_m + curved_rise_m(line, d, resolution_m));
  return depths;
}

/// Height of a rim, or lower than all: what is no rim is no side of a pit.
GVOM_HD inline float rim_height_m(float ground_m, bool is_rim) {
  return is_rim ? ground_m : -kNone_m;
}

/// How deep known ground lies below the lower of two rims, or 0.
GVOM_HD inline float pit_depth_m(float ground_m, float before_m, float after_m, float least_m) {
  const float depth_m = lower_of(before_m, after_m) - ground_m;
  return depth_m > least_m ? depth_m : 0;
}

/// Numbers of R13 that depend on the configuration.
struct HoleParameters {
  double resolution_m;
  double hole_m;                      ///< So much of a hole that matters shows when it is met.
  double edge_m;                      ///< The same of a drop behind an edge.
  std::int32_t reach;                 ///< Steps to a rim, and to the ground beyond.
  std::int32_t edge_reach;            ///< Steps to the rim of an edge.
  std::int32_t vehicle_x, vehicle_y;  ///< The vehicle's column.
  PitDepths pits;
};

inline constexpr double kHoleShare = 0.08;  ///< Of `negative_threshold`.
inline constexpr double kEdgeShare = 0.34;
inline constexpr double kHolePerRange = 0.003;  ///< What attitude and sampling add, metres a metre.
inline constexpr double kEdgePerRange = 0.004;
inline constexpr double kEdgeUnevenness = 2.5;  ///< Of the rms of the rims; of a hole's, all.
inline constexpr double kEdgeSlope = 0.05;
inline constexpr double kEdgeSlopePerLength_per_m = 0.01;
inline constexpr double kMostRms_m = 0.1;
inline constexpr double kMostSlope = 0.546;  ///< m/m, that of 0.5 rad.
inline constexpr double kMostRise = 0.35;    ///< Of the ground before an edge, m/m.
inline constexpr std::int32_t kNearSteps = 5, kFarSteps = 8, kBendSteps = 8;
inline constexpr double kBend = 8;          ///< Times the bend that is seen, what an edge may still bend.
inline constexpr double kSureBend = 0.4;    ///< Of the rms, a step: what isn't seen as a bend.
inline constexpr double kMirrored_m = 0.3;  ///< A ray so far below ground that is seen was mirrored.
inline constexpr std::int32_t kLeastNeighbours = 2;  ///< Of a hole's column that show one too.

/// What the three columns of a step have, the middle one and the two abreast of it.
struct Abreast {
  const GroundView& view;
  std::int32_t beside;

  [[nodiscard]] GVOM_HD bool has_rim(std::int32_t at) const {
    return (view.is_rim[at] | view.is_rim[at - beside] | view.is_rim[at + beside]) != 0;
  }
  [[nodiscard]] GVOM_HD bool has_ground(std::int32_t at) const {
    return view.ground_m[at] != kNone_m || view.ground_m[at - beside] != kNone_m ||
           view.ground_m[at + beside] != kNone_m;
  }
};

/// One column's search. Of the three columns of a step the middle one counts first, then the one before it
/// and the one behind it in the order of the grid. @param Steps like `Abreast`
template <class Steps>
class HoleSearch {
 public:
  GVOM_HD HoleSearch(const GroundView& view, const Steps& steps, const HoleParameters& p,
                     const SightLine& line, float lowest_ray_m)
      : view_(view), steps_(steps), p_(p), line_(line), lowest_m_(static_cast<double>(lowest_ray_m)) {}

  /// By how much a ray has been below the ground that should be there, or 0. The column has no ground of its
  /// own, and a ray has left it.
  GVOM_HD double depth_m() {
    if (line_.columns() == 0 || !find_rim()) return 0;
    const double hole = hole_depth_m();
    const double edge = edge_depth_m();
    return hole > edge ? hole : edge;
  }

 private:
  /// The ground that should be there, and how uneven it is.
  struct Near {
    RimFit fit;
    std::int32_t last_rim;  ///< Steps from the first one.
  };

  /// The first rim towards the vehicle; no ray that went below it says anything.
  GVOM_HD bool find_rim() {
    const std::int32_t most = last_in_grid(1, p_.reach < line_.columns() ? p_.reach : line_.columns());
    for (rim_steps_ = 1; rim_steps_ <= most; ++rim_steps_)
      if (steps_.has_rim(line_.at(rim_steps_))) break;
    if (rim_steps_ > most) return false;
    const std::int32_t at = line_.at(rim_steps_), beside = line_.beside();
    const std::int32_t rim = is_rim(at) ? at : is_rim(at - beside) ? at - beside : at + beside;
    rim_m_ = static_cast<double>(view_.ground_m[rim]);
    return !(rim_m_ - static_cast<double>(view_.lowest_ray_m[rim]) > kMirrored_m);
  }

  /// The last of `most` steps one way of which a column may be in the grid. @param way 1: to the vehicle
  [[nodiscard]] GVOM_HD std::int32_t last_in_grid(std::int32_t way, std::int32_t most) const {
    while (most > 0 && !line_.reaches(way * most, 1)) --most;
    return most;
  }

  [[nodiscard]] GVOM_HD bool is_rim(std::int32_t at) const { return view_.is_rim[at] != 0; }

  /// Adds the rims of a step, `steps` towards the vehicle, as `k` steps on from where the line begins.
  GVOM_HD bool add_rims(RimLine& line, std::int32_t steps, std::int32_t k) const {
    if (!line_.reaches(steps, 1)) return false;
    const std::int32_t before = line.n, middle = line_.at(steps);
    const std::int32_t columns[3] = {middle, middle - line_.beside(), middle + line_.beside()};
    for (const std::int32_t at : columns)
      if (is_rim(at)) line.add(k, static_cast<double>(view_.ground_m[at]) - rim_m_);
    line.steps += line.n > before ? 1 : 0;
    return line.n > before;
  }

  GVOM_HD Near near_line() const {
    RimLine line;
    std::int32_t last = 0;
    for (std::int32_t k = 0; k < kNearSteps; ++k)
      if (add_rims(line, rim_steps_ + k, k)) last = k;
    return {solve_rims(line), last};
  }

  /// A hole: ground beyond it, whose line begins at the first ground there, and the rim on this side.
  GVOM_HD double hole_depth_m() const {
    const std::int32_t most = last_in_grid(-1, p_.reach + kFarSteps);
    const std::int32_t far = first_ground_beyond(most);
    if (far == 0) return 0;
    std::uint64_t rims = rims_beyond(far, most);
    if (!has_bits(rims, kLeastSteps)) return 0;
    RimLine line;
    for (; rims != 0; rims &= rims - 1) {
      const std::int32_t k = lowest_bit_of(rims);
      add_rims(line, -(far + k), k);
    }
    if (is_surely_lower(line, far)) return 0;
    const RimFit fit = solve_rims(line);
    if (!fits(fit)) return 0;
    const double expected = rim_m_ + fit.at_first_m * rim_steps_ / (rim_steps_ + far);
    const double depth = expected - lowest_m_;
    const double even = p_.hole_m + kHolePerRange * range_m();
    if (!(depth > even)) return 0;
    return depth > even + (fit.rms_m + near_line().fit.rms_m) ? depth : 0;
  }

  /// Whether the ground beyond is so low that no hole can show, however the last bits are rounded: nearly
  /// always, and without a division.
  [[nodiscard]] GVOM_HD bool is_surely_lower(const RimLine& s, std::int32_t far) const {
    constexpr double kRounding_m = 1e-6;
    const double determinant = s.n * s.kk - s.k * s.k;
    const double first = (s.z * s.kk - s.kz * s.k) * rim_steps_;
    const double least = ((lowest_m_ - rim_m_) + p_.hole_m - kRounding_m) * (rim_steps_ + far);
    return first < least * determinant;
  }

  /// Steps to it, or 0. @param most steps that are in the grid
  [[nodiscard]] GVOM_HD std::int32_t first_ground_beyond(std::int32_t most) const {
    const std::int32_t last = most < p_.reach ? most : p_.reach;
    for (std::int32_t far = 1; far <= last; ++far)
      if (steps_.has_ground(line_.at(-far))) return far;
    return 0;
  }

  /// Bit k: the step k beyond `far` has a rim.
  [[nodiscard]] GVOM_HD std::uint64_t rims_beyond(std::int32_t far, std::int32_t most) const {
    std::uint64_t rims = 0;
    for (std::int32_t k = 1; k <= kFarSteps && far + k <= most; ++k)
      rims |= static_cast<std::uint64_t>(steps_.has_rim(line_.at(-(far + k)))) << k;
    return rims;
  }

  /// An edge: the ground before it goes on no higher than level, and bends as it did.
  GVOM_HD double edge_depth_m() const {
    if (rim_steps_ > p_.edge_reach || !(rim_m_ - lowest_m_ > p_.edge_m)) return 0;
    const Near near = near_line();
    if (!fits(near.fit) || near.fit.slope_per_step < -(kMostRise * step_m())) return 0;
    const double slope = slope_behind(near);
    const double rim_m = rim_m_ + (near.fit.at_first_m < 0 ? near.fit.at_first_m : 0);
    const double expected = rim_m + (slope < 0 ? slope : 0) * rim_steps_;
    const double depth = expected - lowest_m_;
    const double flat = (p_.edge_m + kEdgePerRange * range_m()) + kEdgeUnevenness * near.fit.rms_m;
    const double most_slope = kEdgeSlope + kEdgeSlopePerLength_per_m * (near.last_rim * step_m());
    const double steep = most_slope * (rim_steps_ * step_m());
    return depth > (flat > steep ? flat : steep) ? depth : 0;
  }

  /// How the ground goes on away from the vehicle, metres a step: as it is at the edge, and bent as before
  /// it.
  GVOM_HD double slope_behind(const Near& near) const {
    RimLine line;
    for (std::int32_t k = kNearSteps; k < kNearSteps + kBendSteps; ++k) add_rims(line, rim_steps_ + k, k);
    const RimFit earlier = solve_rims(line);
    const double slope = -near.fit.slope_per_step;
    const double bend = (-earlier.slope_per_step - slope) - kSureBend * near.fit.rms_m;
    return earlier.defined && bend > 0 ? slope - kBend * bend : slope;
  }

  [[nodiscard]] GVOM_HD bool fits(const RimFit& fit) const {
    const double slope = fit.slope_per_step < 0 ? -fit.slope_per_step : fit.slope_per_step;
    return fit.defined && fit.rms_m <= kMostRms_m && slope <= kMostSlope * step_m();
  }
  [[nodiscard]] GVOM_HD double step_m() const { return line_.step_m(p_.resolution_m); }
  [[nodiscard]] GVOM_HD double range_m() const { return line_.columns() * step_m(); }

  const GroundView& view_;
  const Steps& steps_;
  const HoleParameters& p_;
  const SightLine& line_;
  double lowest_m_;
  std::int32_t rim_steps_ = 0;
  double rim_m_ = 0;
};

/// A column that a ray has left without having found ground.
GVOM_HD inline bool may_hide_hole(const GroundView& view, std::int32_t at) {
  return view.lowest_ray_m[at] != kNone_m && view.ground_m[at] == kNone_m;
}

/// NEGATIVE (R13): a hole shows in this column, in one abreast of it and in another one around it. @param
/// shows 1 or 0, of all columns
GVOM_HD inline bool is_negative(const ColumnGrid& grid, const std::uint8_t* shows, const HoleParameters& p,
                                std::int32_t x, std::int32_t y) {
  const std::uint8_t* own = shows + grid.at(x, y);
  if (*own == 0) return false;
  const std::int32_t beside = SightLine(grid, x, y, p.vehicle_x, p.vehicle_y).beside();
  if (own[beside] + own[-beside] == 0) return false;
  std::int32_t neighbours = -1;
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) neighbours += own[dy * grid.pitch() + dx];
  return neighbours >= kLeastNeighbours;
}

}  // namespace gvom
