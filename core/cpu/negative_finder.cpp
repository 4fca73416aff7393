#include "core/cpu/negative_finder.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

// What a column and those abreast of it have, on a line along x and on one along y.
enum StepMark : std::uint8_t { kRimAlongX = 1, kRimAlongY = 2, kGroundAlongX = 4, kGroundAlongY = 8 };

// As `gvom::Abreast`, from marks.
struct MarkedSteps {
  const std::uint8_t* marks;
  std::uint8_t rim, ground;

  [[nodiscard]] bool has_rim(std::int32_t at) const { return (marks[at] & rim) != 0; }
  [[nodiscard]] bool has_ground(std::int32_t at) const { return (marks[at] & ground) != 0; }
};

GVOM_CLONES void mark_row(const std::uint8_t* is_rim, const float* ground_m, std::int32_t pitch,
                          std::int32_t n, std::uint8_t* marks) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    const int beside_x = is_rim[x - 1] | is_rim[x + 1], beside_y = is_rim[x - pitch] | is_rim[x + pitch];
    const int lowest_x = static_cast<int>(lower_of(ground_m[x - 1], ground_m[x + 1]) != kNone_m);
    const int lowest_y = static_cast<int>(lower_of(ground_m[x - pitch], ground_m[x + pitch]) != kNone_m);
    const int own = static_cast<int>(ground_m[x] != kNone_m);
    const int along_x = (is_rim[x] | beside_y) * kRimAlongX | (own | lowest_y) * kGroundAlongX;
    const int along_y = (is_rim[x] | beside_x) * kRimAlongY | (own | lowest_x) * kGroundAlongY;
    marks[x] = static_cast<std::uint8_t>(along_x | along_y);
  }
}

// The formulas of core/negative.hpp over the columns of a row.

GVOM_CLONES void read_rims(const float* ground_m, const std::uint8_t* is_rim, std::int32_t n, float* rim_m) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) rim_m[x] = rim_height_m(ground_m[x], is_rim[x] != 0);
}

GVOM_CLONES void deepen(const float* ground_m, const float* rim_m, std::int32_t offset, float least_m,
                        std::int32_t n, float* depth_m) {
  const float* after_m = rim_m + offset;
  const float* before_m = rim_m - offset;
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    const float pit_m = pit_depth_m(ground_m[x], before_m[x], after_m[x], least_m);
    depth_m[x] = pit_m > depth_m[x] ? pit_m : depth_m[x];
  }
}

}  // namespace

NegativeFinder::NegativeFinder(std::int32_t n_xy) {
  const auto size = static_cast<std::size_t>(ColumnGrid{n_xy}.size());
  steps_.resize(size);
  rim_m_.resize(size, -kNone_m);
  shows_.resize(size);
}

void NegativeFinder::find(const ColumnParameters& p, const GroundView& ground, const LayerArrays& out) {
  const ColumnGrid& grid = ground.grid;
  const HoleParameters holes = hole_parameters(p);
  mark_steps(ground);
  find_pits(holes, ground, out);
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i) {
      const std::int32_t at = grid.at(x, y);
      if (may_hide_hole(ground, at))
        out.negative_delta[i] = static_cast<float>(hole_depth_m(ground, holes, x, y));
      shows_[static_cast<std::size_t>(at)] = out.negative_delta[i] > 0 ? 1 : 0;
    }
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i)
      if (is_negative(grid, shows_.data(), holes, x, y)) out.flags[i] |= kNegative;
}

void NegativeFinder::mark_steps(const GroundView& ground) {
  const std::int32_t n = ground.grid.n_xy;
  for (std::int32_t y = -1; y <= n; ++y) {
    const std::int32_t row = ground.grid.at(-1, y);
    mark_row(ground.is_rim + row, ground.ground_m + row, ground.grid.pitch(), n + 2, steps_.data() + row);
  }
}

double NegativeFinder::hole_depth_m(const GroundView& ground, const HoleParameters& holes, std::int32_t x,
                                    std::int32_t y) const {
  const SightLine line(ground.grid, x, y, holes.vehicle_x, holes.vehicle_y);
  const bool along_y = line.beside() == 1;
  const MarkedSteps steps{steps_.data(), along_y ? kRimAlongY : kRimAlongX,
                          along_y ? kGroundAlongY : kGroundAlongX};
  return HoleSearch(ground, steps, holes, line, ground.lowest_ray_m[ground.grid.at(x, y)]).depth_m();
}

void NegativeFinder::find_pits(const HoleParameters& holes, const GroundView& ground,
                               const LayerArrays& out) {
  const std::int32_t n = ground.grid.n_xy;
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = ground.grid.at(0, y);
    read_rims(ground.ground_m + row, ground.is_rim + row, n, rim_m_.data() + row);
  }
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = ground.grid.at(0, y);
    float* const depth_m = out.negative_delta + y * n;
    std::fill_n(depth_m, n, 0.0F);
    for (std::int32_t line = 0; line < kLines; ++line)
      for (std::int32_t d = 1; d <= kPitSides; ++d)
        deepen(ground.ground_m + row, rim_m_.data() + row, d * line_offset(ground.grid, line),
               holes.pits.least_m[line][d - 1], n, depth_m);
  }
}

}  // namespace gvom::cpu
