#include "tools/drive/paper_rules.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace gvom::driving {
namespace {

std::uint8_t byte_of(Visibility visibility) {
  return static_cast<std::uint8_t>(visibility);
}

bool is_assumed(const ColumnParameters& p, std::int32_t x, std::int32_t y) {
  return assumed_ground_m(p, x, y) != kNone_m;
}

}  // namespace

PaperGround::PaperGround(std::int32_t n_xy) : grid_{n_xy} {
  ground_m_.resize(static_cast<std::size_t>(grid_.size()), kNone_m);
  is_rim_.resize(ground_m_.size());
}

float PaperGround::find_column(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                               std::int32_t y, const LayerArrays& out) const {
  const std::int32_t i = y * grid_.n_xy + x;
  const std::size_t mask = map.column(x, y) * static_cast<std::size_t>(map.words);
  const std::int32_t z = lowest_bit(map.occupied + mask, map.words);
  out.flags[i] = 0;
  if (z >= 0) {
    const bool remembered = map.memory.remembered != nullptr && has_bit(map.memory.remembered + mask, z);
    out.visibility[i] = byte_of(remembered ? Visibility::remembered : Visibility::ground_seen);
    return map.min_height_m[map.cell(x, y, z)];
  }
  if (is_assumed(p, x, y)) {
    out.flags[i] = kAssumed;
    out.visibility[i] = byte_of(Visibility::ground_assumed);
    return static_cast<float>(p.ground_under_vehicle_m);
  }
  if (out.visibility[i] != byte_of(Visibility::unobserved))
    out.visibility[i] = without_height(out.visibility[i]);
  return kNone_m;
}

GroundView PaperGround::find(const FusedView& map, const ColumnParameters& p, const GroundView& ours,
                             const LayerArrays& out) {
  for (std::int32_t y = 0; y < grid_.n_xy; ++y)
    for (std::int32_t x = 0; x < grid_.n_xy; ++x) {
      const auto at = static_cast<std::size_t>(grid_.at(x, y));
      const float ground_m = find_column(map, p, x, y, out);
      ground_m_[at] = ground_m;
      is_rim_[at] = static_cast<std::uint8_t>(ground_m != kNone_m);
      out.height[y * grid_.n_xy + x] = ground_m == kNone_m ? kUnknown : ground_m;
    }
  return {grid_, ours.lowest_ray_m, ground_m_.data(), is_rim_.data()};
}

PaperHoles::PaperHoles(std::int32_t n_xy) : n_(n_xy) {
  along_x_.resize(static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy));
  along_y_.resize(along_x_.size());
}

void PaperHoles::measure(const float* height_m, std::int32_t step, std::int32_t across,
                         std::vector<std::int32_t>& to) {
  for (std::int32_t line = 0; line < n_; ++line) {
    const std::int32_t first = line * across;
    std::int32_t last = -kNowhere;
    for (std::int32_t k = 0; k < n_; ++k) {
      if (!std::isnan(height_m[first + k * step])) last = k;
      to[static_cast<std::size_t>(first + k * step)] = last - k;
    }
    last = 2 * kNowhere;
    for (std::int32_t k = n_ - 1; k >= 0; --k) {
      std::int32_t& nearest = to[static_cast<std::size_t>(first + k * step)];
      if (!std::isnan(height_m[first + k * step])) last = k;
      if (last - k < std::abs(nearest)) nearest = last - k;
    }
  }
}

float PaperHoles::delta_m(const float* height_m, std::int32_t x, std::int32_t y,
                          std::int32_t search_distance) const {
  float highest_m = -kNone_m, lowest_m = kNone_m;
  const auto look = [&](std::int32_t dx, std::int32_t dy) {
    for (std::int32_t d = 1; d <= search_distance; ++d) {
      const std::int32_t cx = x + d * dx, cy = y + d * dy;
      if (cx < 0 || cy < 0 || cx >= n_ || cy >= n_) return;
      const std::int32_t at = cy * n_ + cx;
      const std::int32_t aside = (dx != 0 ? along_y_ : along_x_)[static_cast<std::size_t>(at)];
      if (std::abs(aside) > d) continue;
      const float found_m = height_m[at + aside * (dx != 0 ? n_ : 1)];
      highest_m = std::max(highest_m, found_m);
      lowest_m = std::min(lowest_m, found_m);
      return;
    }
  };
  look(1, 0), look(-1, 0), look(0, 1), look(0, -1);
  return highest_m > lowest_m ? highest_m - lowest_m : 0;
}

void PaperHoles::find(const LayersConfig& config, const LayerArrays& out) {
  measure(out.height, 1, n_, along_x_);
  measure(out.height, n_, 1, along_y_);
  for (std::int32_t y = 0; y < n_; ++y)
    for (std::int32_t x = 0; x < n_; ++x) {
      const std::int32_t i = y * n_ + x;
      const bool known = !std::isnan(out.height[i]);
      out.negative_delta[i] = known ? 0 : delta_m(out.height, x, y, config.search_distance);
      if (static_cast<double>(out.negative_delta[i]) > config.negative_threshold_m) out.flags[i] |= kNegative;
    }
}

}  // namespace gvom::driving
