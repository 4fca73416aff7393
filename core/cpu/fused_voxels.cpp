// The fused voxels as a brick map (R6).
#include <algorithm>

#include "core/cpu/fused_map.hpp"

namespace gvom::cpu {

BrickMapShape FusedMap::shape() const {
  BrickMapShape shape{grid_.brick_slots(), 0, 0, grid_.columns()};
  for (std::uint32_t slot = 0; slot < shape.brick_slots; ++slot) {
    shape.brick_count += live_[slot];
    shape.record_count += hit_cells_[slot];
  }
  return shape;
}

VoxelRecord FusedMap::window_voxel(std::size_t i) const {
  if (memory_.on() && memory_.shows(i)) return kUnknownVoxel;
  return {hits_[i], passes_[i], min_height_m_[i]};
}

void FusedMap::write(const BrickMapArrays& out) const {
  std::fill_n(out.directory, grid_.brick_slots(), -1);
  const Int3 n = grid_.bricks();
  std::int32_t brick = 0;
  std::int32_t record = 0;
  std::uint32_t slot = 0;
  for (std::int32_t bz = 0; bz < n[2]; ++bz)
    for (std::int32_t by = 0; by < n[1]; ++by)
      for (std::int32_t bx = 0; bx < n[0]; ++bx, ++slot) {
        const std::uint32_t place =
            slot_of({grid_.origin[0] / kBrickEdge + bx, grid_.origin[1] / kBrickEdge + by,
                     grid_.origin[2] / kBrickEdge + bz});
        if (!live_[place]) continue;
        std::uint64_t columns = 0;
        for (std::size_t cell = 0; cell < kBrickCells; ++cell) {
          const std::size_t i = std::size_t{place} * kBrickCells + cell;
          std::int32_t& lookup = out.lookup[static_cast<std::size_t>(brick) * kBrickCells + cell];
          const VoxelRecord voxel = window_voxel(i);
          if (voxel.hits + voxel.passes != 0) columns |= std::uint64_t{1} << (cell >> 3);
          lookup = voxel.hits > 0 ? record : free_lookup(voxel.passes);
          if (voxel.hits > 0) out.records[record++] = voxel;
        }
        out.directory[slot] = brick;
        out.columns[brick++] = columns;
      }
  for (std::int32_t by = 0, stack = 0; by < n[1]; ++by)
    for (std::int32_t bx = 0; bx < n[0]; ++bx, ++stack)
      std::copy_n(lowest_ray_m_.data() +
                      stack_at(grid_.origin[0] / kBrickEdge + bx, grid_.origin[1] / kBrickEdge + by).rays,
                  kBrickColumns, out.lowest_ray_m + std::ptrdiff_t{stack} * kBrickColumns);
}

}  // namespace gvom::cpu
