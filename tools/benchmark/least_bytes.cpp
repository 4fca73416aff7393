#include "tools/benchmark/least_bytes.hpp"

#include <algorithm>
#include <vector>

#include "core/format/brick_map.hpp"
#include "tools/benchmark/drive.hpp"

namespace gvom::bench {

namespace {

// Directory, lookup values, observed columns, lowest rays and records.
double bytes_of(const BrickMapShape& shape) {
  return shape.brick_slots * 4.0 + shape.brick_count * (kBrickCells * 4.0 + 8.0) +
         shape.column_count * double{sizeof(float)} + shape.record_count * double{sizeof(VoxelRecord)};
}

Int3 brick_of_slot(const Grid& grid, std::int32_t slot) {
  const Int3 n = grid.bricks();
  return {grid.origin[0] / kBrickEdge + slot % n[0], grid.origin[1] / kBrickEdge + slot / n[0] % n[1],
          grid.origin[2] / kBrickEdge + slot / (n[0] * n[1])};
}

// Marks the bricks of `grid` that a map touches, by slot.
void mark_bricks(const BrickMapView& map, const Grid& grid, std::vector<bool>& marks) {
  for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(marks.size()); ++slot)
    if (map.brick_at(brick_of_slot(grid, slot)) >= 0) marks[static_cast<std::size_t>(slot)] = true;
}

// What the window's maps, but for the newest, have in the bricks that enter: lookup values and observed
// columns. Marks these bricks, all of them.
double entering_bytes(const Window& window, const Grid& before, std::vector<bool>& marks) {
  const Grid& grid = window.maps().front().view.grid;
  double bytes = 0;
  for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(marks.size()); ++slot) {
    const Int3 brick = brick_of_slot(grid, slot);
    if (before.slot_of_brick(brick) >= 0) continue;
    marks[static_cast<std::size_t>(slot)] = true;
    for (std::size_t i = 1; i < window.maps().size(); ++i)
      if (window.maps()[i].view.brick_at(brick) >= 0) bytes += kBrickCells * 4.0 + 8.0;
  }
  return bytes;
}

double fuse_bytes(const Window& window, const Grid& before) {
  const BrickMapView& added = window.maps().front().view;
  std::vector<bool> touched(added.grid.brick_slots());
  double bytes = bytes_of(added.shape) + entering_bytes(window, before, touched);
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
  const double entering = bricks_entering(added.grid, before);
  return bytes + (2 * count(touched) - entering) * 12.0 * kBrickCells + count(touched) * 2 * kBrickColumns +
         count(stacks) * kBrickColumns * 2 * 8.0;
}

double layers_bytes(const Grid& grid, const LayerArrays& layers) {
  const auto columns = static_cast<std::ptrdiff_t>(grid.size[0]) * grid.size[1];
  const auto grounds = std::count(layers.visibility, layers.visibility + columns,
                                  static_cast<std::uint8_t>(Visibility::ground_seen));
  const int mask_words = (grid.size[2] + 63) / 64;
  return static_cast<double>(columns) * (2 * 8.0 * mask_words + 8.0 + 4.0) +
         static_cast<double>(grounds) * 12.0 + static_cast<double>(layers.bytes_in_one);
}

}  // namespace

LeastBytes least_bytes(const Window& window, const Grid& before, const LayerArrays& layers) {
  const BrickMapView& added = window.maps().front().view;
  return {static_cast<double>(added.bytes_in_one), fuse_bytes(window, before),
          layers_bytes(added.grid, layers), static_cast<double>(layers.bytes_in_one)};
}

}  // namespace gvom::bench
