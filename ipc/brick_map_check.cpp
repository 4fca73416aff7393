// What the arrays of a map hold. Loops over all voxels are plain enough to be vectorized.
#include <cmath>
#include <cstdint>

#include "ipc/brick_map.hpp"

namespace gvom::ipc {
namespace {

using Checked = tl::expected<void, MapFault>;
using Part = MapFault::Part;

Checked broken(Part part, std::string why) {
  return tl::unexpected(MapFault{part, "map refused: " + std::move(why)});
}

Checked check_directory(Span<const std::int32_t> directory, std::uint32_t brick_count) {
  std::uint32_t bricks = 0;
  for (const std::int32_t brick : directory) {
    if (brick == -1) continue;
    if (static_cast<std::uint32_t>(brick) != bricks || bricks == brick_count) {
      return broken(Part::directory, "the directory has brick " + std::to_string(brick) + " where brick " +
                                         std::to_string(bricks) + " of " + std::to_string(brick_count) +
                                         " is next");
    }
    ++bricks;
  }
  if (bricks == brick_count) return {};
  return broken(Part::directory, std::to_string(bricks) + " of " + std::to_string(brick_count) +
                                     " bricks are in the directory");
}

/// What the lookup values of a brick say.
struct BrickSums {
  std::uint32_t hits = 0;     // voxels that lead to a record
  std::uint32_t beyond = 0;   // of these, to one that is not there
  std::uint64_t columns = 0;  // bit x * 8 + y: the column has an observed voxel
};

BrickSums sums_of(const std::int32_t* lookup, std::int32_t record_count) {
  constexpr std::int32_t kUnobserved = -1;
  BrickSums sums;
  std::uint8_t observed[kBrickColumns];
  for (int column = 0; column < kBrickColumns; ++column) {
    std::uint32_t any = 0;
    for (int i = column * kBrickEdge; i < (column + 1) * kBrickEdge; ++i) {
      any |= static_cast<std::uint32_t>(lookup[i] ^ kUnobserved);
      sums.hits += lookup[i] >= 0 ? 1 : 0;
      sums.beyond += lookup[i] >= record_count ? 1 : 0;
    }
    observed[column] = any != 0 ? 1 : 0;
  }
  for (int column = 0; column < kBrickColumns; ++column)
    sums.columns |= std::uint64_t{observed[column]} << column;
  return sums;
}

Checked check_bricks(const BrickMapSample& map) {
  const std::uint32_t records = map.header().shape.record_count;
  std::uint64_t hits = 0;
  for (std::uint32_t brick = 0; brick < map.header().shape.brick_count; ++brick) {
    const BrickSums sums =
        sums_of(map.lookup().data() + std::size_t{brick} * kBrickCells, static_cast<std::int32_t>(records));
    hits += sums.hits;
    if (sums.beyond != 0) {
      return broken(Part::lookup, std::to_string(sums.beyond) + " voxels of brick " + std::to_string(brick) +
                                      " lead beyond the last of " + std::to_string(records) + " records");
    }
    if (sums.columns != map.columns()[brick]) {
      return broken(Part::columns, "the columns of brick " + std::to_string(brick) +
                                       " are not those with an observed voxel");
    }
  }
  if (hits == records) return {};
  return broken(Part::lookup,
                std::to_string(hits) + " voxels lead to " + std::to_string(records) + " records");
}

constexpr float kHighest_m = 1.1e7F;  // the farthest position, and a lidar's reach from there

Checked check_lowest_rays(Span<const float> lowest_m) {
  for (const float lowest : lowest_m) {
    if (std::abs(lowest) <= kHighest_m || lowest == kNoRay_m) continue;
    return broken(Part::lowest_ray,
                  "a ray's lowest point in a column is at " + std::to_string(lowest) + " m");
  }
  return {};
}

Checked check_records(Span<const VoxelRecord> records) {
  for (const VoxelRecord& record : records) {
    if (record.hits == 0 || !(std::abs(record.min_height_m) <= kHighest_m)) {
      return broken(Part::records, "a record has " + std::to_string(record.hits) + " hits, the lowest at " +
                                       std::to_string(record.min_height_m) + " m");
    }
  }
  return {};
}

}  // namespace

tl::expected<void, MapFault> BrickMapSample::validate_deep() const {
  return check_directory(directory(), header().shape.brick_count)
      .and_then([this] { return check_bricks(*this); })
      .and_then([this] { return check_lowest_rays(lowest_ray_m()); })
      .and_then([this] { return check_records(records()); });
}

}  // namespace gvom::ipc
