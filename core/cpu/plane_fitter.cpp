#include "core/cpu/plane_fitter.hpp"

#include <algorithm>
#include <cmath>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

// The formulas of core/plane.hpp over a row whose numbers lie side by side, so that the compiler takes
// several columns at a time.

// Heights of seen or assumed ground.
GVOM_CLONES void copy_ground(const float* height_m, const float* ground_m, std::int32_t n, float* out_m) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) out_m[x] = ground_m[x] != kNone_m ? height_m[x] : kUnknown;
}

GVOM_CLONES void add_row(const float* z_m, std::int32_t n, std::int32_t dx, std::int32_t dy,
                         const SumRows& rows) {
  GVOM_INDEPENDENT
  for (std::int32_t i = 0; i < n; ++i) {
    PlaneSums s{rows.n[i],  rows.x[i], rows.y[i],  rows.xx[i], rows.xy[i],
                rows.yy[i], rows.z[i], rows.xz[i], rows.yz[i]};
    add_height(s, dx, dy, z_m[i]);
    rows.n[i] = s.n, rows.x[i] = s.x, rows.y[i] = s.y;
    rows.xx[i] = s.xx, rows.xy[i] = s.xy, rows.yy[i] = s.yy;
    rows.z[i] = s.z, rows.xz[i] = s.xz, rows.yz[i] = s.yz;
  }
}

// All of a plane of 3 x 3 columns at once: its sums stay in registers.
GVOM_CLONES void sum_three_rows(const float* z_m, std::ptrdiff_t width, std::int32_t n, const SumRows& rows) {
  const float *before_m = z_m - width, *after_m = z_m + width;
  GVOM_INDEPENDENT
  for (std::int32_t i = 0; i < n; ++i) {
    PlaneSums s{0, 0, 0, 0, 0, 0, 0, 0, 0};
    add_height(s, -1, -1, before_m[i - 1]), add_height(s, 0, -1, before_m[i]),
        add_height(s, 1, -1, before_m[i + 1]);
    add_height(s, -1, 0, z_m[i - 1]), add_height(s, 0, 0, z_m[i]), add_height(s, 1, 0, z_m[i + 1]);
    add_height(s, -1, 1, after_m[i - 1]), add_height(s, 0, 1, after_m[i]),
        add_height(s, 1, 1, after_m[i + 1]);
    rows.n[i] = s.n, rows.x[i] = s.x, rows.y[i] = s.y;
    rows.xx[i] = s.xx, rows.xy[i] = s.xy, rows.yy[i] = s.yy;
    rows.z[i] = s.z, rows.xz[i] = s.xz, rows.yz[i] = s.yz;
  }
}

GVOM_CLONES void solve_row(std::int32_t n, const SumRows& rows, const FitRows& fits) {
  GVOM_INDEPENDENT
  for (std::int32_t i = 0; i < n; ++i) {
    const PlaneFit fit = solve_plane({rows.n[i], rows.x[i], rows.y[i], rows.xx[i], rows.xy[i], rows.yy[i],
                                      rows.z[i], rows.xz[i], rows.yz[i]});
    fits.a[i] = fit.a, fits.b[i] = fit.b, fits.c[i] = fit.c;
    fits.defined[i] = fit.defined;
    fits.squares_m2[i] = 0;
  }
}

GVOM_CLONES void add_squares(const float* z_m, std::int32_t n, std::int32_t dx, std::int32_t dy,
                             const FitRows& fits) {
  GVOM_INDEPENDENT
  for (std::int32_t i = 0; i < n; ++i)
    fits.squares_m2[i] += squared_residual({fits.a[i], fits.b[i], fits.c[i], true}, dx, dy, z_m[i]);
}

}  // namespace

PlaneFitter::PlaneFitter(std::int32_t n_xy, std::int32_t plane_size)
    : n_xy_(n_xy),
      radius_(plane_size / 2),
      padded_(static_cast<std::size_t>(n_xy + 2 * radius_) * static_cast<std::size_t>(n_xy + 2 * radius_),
              NAN),
      integers_(7 * static_cast<std::size_t>(n_xy)),
      doubles_(7 * static_cast<std::size_t>(n_xy)) {
  std::int32_t* i = integers_.data();
  double* d = doubles_.data();
  sums_ = {i, i + n_xy, i + 2 * n_xy, i + 3 * n_xy, i + 4 * n_xy, i + 5 * n_xy, d, d + n_xy, d + 2 * n_xy};
  fits_ = {d + 3 * n_xy, d + 4 * n_xy, d + 5 * n_xy, d + 6 * n_xy, i + 6 * n_xy};
}

void PlaneFitter::add_up(const float* centre_m, std::ptrdiff_t width) {
  if (radius_ == 1) return sum_three_rows(centre_m, width, n_xy_, sums_);
  std::fill(integers_.begin(), integers_.end(), 0);
  std::fill(doubles_.begin(), doubles_.end(), 0.0);
  for (std::int32_t dy = -radius_; dy <= radius_; ++dy)
    for (std::int32_t dx = -radius_; dx <= radius_; ++dx)
      add_row(centre_m + dy * width + dx, n_xy_, dx, dy, sums_);
}

void PlaneFitter::fit(const ColumnParameters& p, const GroundView& ground, const LayerArrays& out) {
  const std::ptrdiff_t width = n_xy_ + 2 * radius_;
  for (std::int32_t y = 0; y < n_xy_; ++y)
    copy_ground(out.height + std::ptrdiff_t{y} * n_xy_, ground.ground_m + ground.grid.at(0, y), n_xy_,
                padded_.data() + (y + radius_) * width + radius_);
  for (std::ptrdiff_t y = 0; y < n_xy_; ++y) {
    const float* centre = padded_.data() + (y + radius_) * width + radius_;
    add_up(centre, width);
    solve_row(n_xy_, sums_, fits_);
    for (std::int32_t dy = -radius_; dy <= radius_; ++dy)
      for (std::int32_t dx = -radius_; dx <= radius_; ++dx)
        add_squares(centre + dy * width + dx, n_xy_, dx, dy, fits_);
    for (std::ptrdiff_t x = 0; x < n_xy_; ++x) {
      const PlaneFit fit{fits_.a[x], fits_.b[x], fits_.c[x], fits_.defined[x] != 0};
      const PlaneSums sums{sums_.n[x],  sums_.x[x], sums_.y[x],  sums_.xx[x], sums_.xy[x],
                           sums_.yy[x], sums_.z[x], sums_.xz[x], sums_.yz[x]};
      const std::ptrdiff_t i = y * n_xy_ + x;
      const auto source = [&](std::int32_t dx, std::int32_t dy) {
        if (std::isnan(centre[x + dy * width + dx])) return kNoGround;
        return source_of_ground(out.visibility[i + std::ptrdiff_t{dy} * n_xy_ + dx]);
      };
      const Plane plane =
          plane_layers(fit, sums, fits_.squares_m2[x], p.resolution_xy_m, p.layers.slope_threshold_rad,
                       [&] { return is_seam(radius_, source); });
      out.slope_x[i] = plane.slope_x;
      out.slope_y[i] = plane.slope_y;
      out.slope[i] = plane.slope;
      out.roughness[i] = plane.roughness;
      if (plane.steep) out.flags[i] |= kSteep;
    }
  }
}

}  // namespace gvom::cpu
