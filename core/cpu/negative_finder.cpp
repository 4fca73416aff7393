#include "core/cpu/negative_finder.hpp"

#include <algorithm>
#include <cmath>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

// Offsets are 16 bits wide throughout, so that the compiler takes many columns at a time.
using Offset = std::int16_t;
constexpr Offset kFar = kNoneInRow;

// The offset (<= 0) to the nearest defined height at or before a column, given the one at its predecessor.
GVOM_INLINE Offset before(float height, Offset previous) {
  const auto further = static_cast<Offset>(previous > -kFar ? previous - 1 : -kFar);
  return std::isnan(height) ? further : Offset{0};
}

// The same (>= 0) for heights after it.
GVOM_INLINE Offset after(float height, Offset next) {
  const auto further = static_cast<Offset>(next < kFar ? next + 1 : kFar);
  return std::isnan(height) ? further : Offset{0};
}

// The nearer of both, on a tie the one before.
GVOM_INLINE Offset nearer(Offset before_it, Offset after_it) {
  return -before_it <= after_it ? before_it : after_it;
}

void nearest_along_x(const float* height, std::int32_t n, Offset* nearest) {
  Offset offset = -kFar;
  for (std::int32_t x = 0; x < n; ++x) nearest[x] = offset = before(height[x], offset);
  offset = kFar;
  for (std::int32_t x = n - 1; x >= 0; --x) {
    offset = after(height[x], offset);
    nearest[x] = nearer(nearest[x], offset);
  }
}

GVOM_CLONES void nearest_along_y(const float* height, std::int32_t n, Offset* nearest, Offset* after_it) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) nearest[x] = before(height[x], -kFar);
  for (std::ptrdiff_t row = n; row < std::ptrdiff_t{n} * n; row += n) {
    GVOM_INDEPENDENT
    for (std::int32_t x = 0; x < n; ++x) nearest[row + x] = before(height[row + x], nearest[row - n + x]);
  }
  std::fill_n(after_it, n, kFar);
  for (std::ptrdiff_t row = std::ptrdiff_t{n} * (n - 1); row >= 0; row -= n) {
    GVOM_INDEPENDENT
    for (std::int32_t x = 0; x < n; ++x) {
      after_it[x] = after(height[row + x], after_it[x]);
      nearest[row + x] = nearer(nearest[row + x], after_it[x]);
    }
  }
}

// search_cone for all columns of row y.
GVOM_CLONES void search_row(const NearestHeights& nearest, std::int32_t n, std::int32_t y, int direction,
                            std::int32_t distance, Offset* found) {
  const std::int32_t dx = direction_x(direction), dy = direction_y(direction);
  const Offset* row = (dx != 0 ? nearest.along_y : nearest.along_x) + std::ptrdiff_t{n} * y;
  std::fill_n(found, n, Offset{0});
  for (Offset i = 1; i <= distance && i < n; ++i) {
    if (y + i * dy < 0 || y + i * dy >= n) return;
    const Offset* ahead = row + std::ptrdiff_t{i} * (dy * n + dx);
    const std::int32_t end = dx > 0 ? n - i : n;
    GVOM_INDEPENDENT
    for (std::int32_t x = dx < 0 ? i : 0; x < end; ++x) {
      const bool first = (static_cast<int>(found[x] == 0) & static_cast<int>(in_cone(ahead[x], i))) != 0;
      found[x] = first ? i : found[x];
    }
  }
}

}  // namespace

NegativeFinder::NegativeFinder(std::int32_t n_xy)
    : n_xy_(n_xy),
      along_x_(static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy)),
      along_y_(along_x_.size()),
      after_(static_cast<std::size_t>(n_xy)),
      found_(kDirections * after_.size()) {
  searched_.reserve(after_.size());
}

bool NegativeFinder::find_seen_through(std::int32_t y, const LayerArrays& out) {
  searched_.clear();
  for (std::int32_t x = 0, i = y * n_xy_; x < n_xy_; ++x, ++i)
    if (seen_through(out.height[i], out.inferred_height[i])) searched_.push_back(x);
  return !searched_.empty();
}

void NegativeFinder::find(const ColumnParameters& p, const LayerArrays& out) {
  for (std::ptrdiff_t row = 0; row < std::ptrdiff_t{n_xy_} * n_xy_; row += n_xy_)
    nearest_along_x(out.height + row, n_xy_, along_x_.data() + row);
  nearest_along_y(out.height, n_xy_, along_y_.data(), after_.data());
  const NearestHeights nearest{along_x_.data(), along_y_.data()};
  std::fill_n(out.negative_delta, std::ptrdiff_t{n_xy_} * n_xy_, 0.0f);
  for (std::int32_t y = 0; y < n_xy_; ++y) {
    if (!find_seen_through(y, out)) continue;
    Offset* found[kDirections];
    for (int d = 0; d < kDirections; ++d) {
      found[d] = found_.data() + std::ptrdiff_t{d} * n_xy_;
      search_row(nearest, n_xy_, y, d, p.layers.search_distance, found[d]);
    }
    for (const std::int32_t x : searched_) {
      const std::int32_t i = y * n_xy_ + x;
      const double delta_m =
          negative_delta(out.height, nearest, n_xy_, i, {found[0][x], found[1][x], found[2][x], found[3][x]},
                         out.inferred_height[i]);
      out.negative_delta[i] = static_cast<float>(delta_m);
      if (delta_m > p.layers.negative_threshold_m) out.flags[i] |= kNegative;
    }
  }
}

}  // namespace gvom::cpu
