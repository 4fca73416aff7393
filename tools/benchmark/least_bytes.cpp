#include "tools/benchmark/least_bytes.hpp"

#include <algorithm>
#include <vector>

#include "core/format/brick_map.hpp"

namespace gvom::bench {

namespace {

constexpr double kBrickColumns = kBrickEdge * kBrickEdge;

// Directory, lookup values, observed columns and records.
double bytes_of(const BrickMapShape& shape) {
  return shape.brick_slots * 4.0 + shape.brick_count * (kBrickCells * 4.0 + 8.0) +
         shape.record_count * double{sizeof(VoxelRecord)};
}

// Marks the bricks of `grid` that a map touches, by slot.
void mark_bricks(const BrickMapView& map, const Grid& grid, std::vector<bool>& marks) {
  const Int3 n = grid.bricks();
  for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(marks.size()); ++slot) {
    const Int3 brick{grid.origin[0] / kBrickEdge + slot % n[0],
                     grid.origin[1] / kBrickEdge + slot / n[0] % n[1],
                     grid.origin[2] / kBrickEdge + slot / (n[0] * n[1])};
    if (map.brick_at(brick) >= 0) marks[static_cast<std::size_t>(slot)] = true;
  }
}

double fuse_bytes(const Window& window) {
  const BrickMapView& added = window.maps().front().view;
  double bytes = bytes_of(added.shape);
  std::vector<bool> touched(added.grid.brick_slots());
  mark_bricks(added, added.grid, touched);
  for (const WindowMap& left : window.left()) {
    bytes += bytes_of(left.view.shape);
    mark_bricks(left.view, added.grid, touched);
  }
  const Int3 n = added.grid.bricks();
  std::vector<bool> stacks(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]));
  for (std::size_t slot = 0; slot < touched.size(); ++slot)
    if (touched[slot]) stacks[slot % stacks.size()] = true;
  const auto count = [](const std::vector<bool>& marks) {
    return static_cast<double>(std::count(marks.begin(), marks.end(), true));
  };
  return bytes + count(touched) * (2 * 12.0 * kBrickCells + 2 * kBrickColumns) +
         count(stacks) * kBrickColumns * 2 * 8.0;
}

double layers_bytes(const Grid& grid, const LayerArrays& layers) {
  const auto columns = static_cast<std::ptrdiff_t>(grid.size[0]) * grid.size[1];
  const auto grounds = std::count(layers.visibility, layers.visibility + columns,
                                  static_cast<std::uint8_t>(Visibility::ground_seen));
  const int mask_words = (grid.size[2] + 63) / 64;
  return static_cast<double>(columns) * (2 * 8.0 * mask_words + 8.0) + static_cast<double>(grounds) * 4.0 +
         static_cast<double>(layers.bytes_in_one);
}

}  // namespace

LeastBytes least_bytes(const Window& window, const LayerArrays& layers) {
  const BrickMapView& added = window.maps().front().view;
  return {static_cast<double>(added.bytes_in_one), fuse_bytes(window), layers_bytes(added.grid, layers),
          static_cast<double>(layers.bytes_in_one)};
}

}  // namespace gvom::bench
