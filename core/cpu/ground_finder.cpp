#include "core/cpu/ground_finder.hpp"

#include <algorithm>
#include <cstring>

#include "core/cpu/clones.hpp"
#include "core/cpu/stacks.hpp"

namespace gvom::cpu {

namespace {

// The lowest cone over the ground of a row's columns, at the columns of the row.
GVOM_CLONES void spread_along_x(const float* ground_m, const float* rise_m, std::int32_t n, float* cone_m) {
  std::copy_n(ground_m, n, cone_m);
  for (std::int32_t d = 1; d <= kConeReach; ++d) {
    GVOM_INDEPENDENT
    for (std::int32_t x = 0; x < n; ++x) {
      const float beside_m = lower_of(ground_m[x - d], ground_m[x + d]) + rise_m[d];
      cone_m[x] = lower_of(cone_m[x], beside_m);
    }
  }
}

// The same of whole columns, from the cones of the rows around.
GVOM_CLONES void spread_along_y(const float* cones_m, const float* rise_m, std::int32_t pitch, std::int32_t n,
                                float* cone_m) {
  std::copy_n(cones_m, n, cone_m);
  for (std::int32_t d = 1; d <= kConeReach; ++d) {
    const float* above_m = cones_m + d * pitch;
    const float* below_m = cones_m - d * pitch;
    GVOM_INDEPENDENT
    for (std::int32_t x = 0; x < n; ++x)
      cone_m[x] = lower_of(cone_m[x], lower_of(above_m[x], below_m[x]) + rise_m[d]);
  }
}

GVOM_CLONES void mark_standing(const float* ground_m, std::int32_t offset, float allowed_m, std::int32_t n,
                               std::uint8_t* standing) {
  const float* after_m = ground_m + offset;
  const float* before_m = ground_m - offset;
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x)
    standing[x] |= static_cast<std::uint8_t>(rises_over(ground_m[x], after_m[x], before_m[x], allowed_m));
}

GVOM_CLONES void mark_rims(const float* ground_m, const float* cone_m, std::int32_t n, std::uint8_t* standing,
                           std::uint8_t* is_rim, std::int8_t* votes) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    const bool rim = gvom::is_rim(ground_m[x], cone_m[x], standing[x] != 0);
    is_rim[x] = static_cast<std::uint8_t>(rim);
    votes[x] = rim_vote(ground_m[x], rim);
    const int doubtful = static_cast<int>(towers(ground_m[x], cone_m[x])) * kDoubtful;
    standing[x] = static_cast<std::uint8_t>(standing[x] | doubtful);
  }
}

GVOM_CLONES void count_along_x(const std::int8_t* votes, std::int32_t n, std::int8_t* sums) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    int sum = votes[x];
    for (std::int32_t d = 1; d <= kConeReach; ++d) sum += votes[x - d] + votes[x + d];
    sums[x] = static_cast<std::int8_t>(sum);
  }
}

// Where the vote of the columns around is against it no ground is a rim, and all is doubtful.
GVOM_CLONES void doubt_ground(const std::int8_t* sums, const float* ground_m, std::int32_t pitch,
                              std::int32_t n, std::uint8_t* standing, std::uint8_t* is_rim) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    int sum = sums[x];
    for (std::int32_t d = 1; d <= kConeReach; ++d) sum += sums[x - d * pitch] + sums[x + d * pitch];
    const int doubtful = static_cast<int>(sum < 0) & static_cast<int>(ground_m[x] < kNone_m);
    standing[x] = static_cast<std::uint8_t>(standing[x] | (doubtful * kDoubtful));
    is_rim[x] = static_cast<std::uint8_t>(is_rim[x] & ~doubtful);
  }
}

// Heights of the columns that know theirs; marks those that ask the columns around them.
GVOM_CLONES void copy_heights(const float* ground_m, const float* lowest_m, const std::uint8_t* standing,
                              std::int32_t n, float* height_m, std::uint8_t* asks_around) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    const bool known = ground_m[x] != kNone_m;
    height_m[x] = known ? ground_m[x] : kUnknown;
    const int hangs = static_cast<int>(!known) & static_cast<int>(lowest_m[x] != kNone_m);
    asks_around[x] = static_cast<std::uint8_t>(hangs | standing[x]);
  }
}

/// Calls `visit(i)` for the bytes that are not 0; their number is a multiple of 8.
template <class Visit>
void for_each_marked(const std::vector<std::uint8_t>& marks, Visit&& visit) {
  for (std::size_t first = 0; first < marks.size(); first += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, marks.data() + first, sizeof eight);
    for (std::size_t i = first; eight != 0; eight >>= 8, ++i)
      if ((eight & 0xFF) != 0) visit(static_cast<std::int32_t>(i));
  }
}

}  // namespace

GroundFinder::GroundFinder(std::int32_t n_xy, double resolution_m) : grid_{n_xy} {
  for (std::int32_t line = 0; line < kLines; ++line)
    for (std::int32_t d = 1; d <= kSides; ++d)
      allowed_rise_m_.push_back(allowed_rise_m(line, d, resolution_m));
  for (std::int32_t d = 0; d <= kConeReach; ++d) cone_rise_m_.push_back(gvom::cone_rise_m(d, resolution_m));
  const auto size = static_cast<std::size_t>(grid_.size());
  for (std::vector<float>* heights : {&lowest_ray_m_, &ground_m_, &lowest_m_, &cone_m_})
    heights->resize(size, kNone_m);
  is_rim_.resize(size);
  standing_.resize(size);
  votes_.resize(size);
  row_votes_.resize(size);
  cone_row_m_.resize(static_cast<std::size_t>(n_xy));
  asks_around_.resize(static_cast<std::size_t>(n_xy));
}

void GroundFinder::find(const FusedView& map, const ColumnParameters& p, const LayerArrays& out) {
  read_columns(map, p, out);
  find_rims();
  write_heights(p, out);
}

void GroundFinder::read_columns(const FusedView& map, const ColumnParameters& p, const LayerArrays& out) {
  for_each_by_stacks(grid_.n_xy, [&](std::int32_t x, std::int32_t y) {
    const auto at = static_cast<std::size_t>(grid_.at(x, y));
    const std::int32_t i = y * grid_.n_xy + x;
    const ColumnGround column = read_ground(map, p, x, y);
    lowest_ray_m_[at] = column.lowest_ray_m;
    ground_m_[at] = column.ground_m;
    lowest_m_[at] = column.lowest_m;
    out.inferred_height[i] = column.inferred_height;
    out.last_seen[i] = column.last_seen;
    out.flags[i] = column.assumed ? kAssumed : 0;
    out.visibility[i] = static_cast<std::uint8_t>(visibility_of(column));
  });
}

void GroundFinder::find_rims() {
  const std::int32_t n = grid_.n_xy;
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = grid_.at(0, y);
    spread_along_x(ground_m_.data() + row, cone_rise_m_.data(), n, cone_m_.data() + row);
    std::fill_n(standing_.data() + row, n, std::uint8_t{0});
    for (std::int32_t line = 0; line < kLines; ++line)
      for (std::int32_t d = 1; d <= kSides; ++d)
        mark_standing(ground_m_.data() + row, d * line_offset(grid_, line),
                      allowed_rise_m_[static_cast<std::size_t>(line * kSides + d - 1)], n,
                      standing_.data() + row);
  }
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = grid_.at(0, y);
    spread_along_y(cone_m_.data() + row, cone_rise_m_.data(), grid_.pitch(), n, cone_row_m_.data());
    mark_rims(ground_m_.data() + row, cone_row_m_.data(), n, standing_.data() + row, is_rim_.data() + row,
              votes_.data() + row);
    count_along_x(votes_.data() + row, n, row_votes_.data() + row);
  }
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = grid_.at(0, y);
    doubt_ground(row_votes_.data() + row, ground_m_.data() + row, grid_.pitch(), n, standing_.data() + row,
                 is_rim_.data() + row);
  }
}

void GroundFinder::write_heights(const ColumnParameters& p, const LayerArrays& out) {
  const std::int32_t n = grid_.n_xy;
  for (std::int32_t y = 0; y < n; ++y) {
    const std::int32_t row = grid_.at(0, y);
    copy_heights(ground_m_.data() + row, lowest_m_.data() + row, standing_.data() + row, n,
                 out.height + y * n, asks_around_.data());
    for_each_marked(asks_around_, [&](std::int32_t x) { ask_around(p, row + x, y * n + x, out); });
  }
}

void GroundFinder::ask_around(const ColumnParameters& p, std::int32_t at, std::int32_t i,
                              const LayerArrays& out) {
  const auto a = static_cast<std::size_t>(at);
  const float height_m = height_by_rims_m(view(), at, lowest_m_[a], standing_[a], p.resolution_xy_m);
  out.height[i] = height_m == kNone_m ? kUnknown : height_m;
  if (height_m == kNone_m) out.visibility[i] = without_height(out.visibility[i]);
}

}  // namespace gvom::cpu
