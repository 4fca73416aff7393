// The fused map (R7, R8) on the CPU, kept up to date by adding the map that came and subtracting those
// that left. Counts are integers, so the result is that of summing the window afresh. Where the window
// observes nothing, voxels show what is remembered (R17).
#pragma once

#include <cstdint>
#include <vector>

#include "core/cell.hpp"
#include "core/config.hpp"
#include "core/cpu/column_masks.hpp"
#include "core/cpu/huge_pages.hpp"
#include "core/cpu/memory.hpp"
#include "core/format/brick_map.hpp"
#include "core/fused_view.hpp"
#include "core/lowest_ray.hpp"
#include "core/window.hpp"

namespace gvom::cpu {

class FusedMap {
 public:
  explicit FusedMap(const MapperConfig& config);

  /// Fuses a map. Its memory must stay until the map is among `window().left()`.
  /// A result other than `added` leaves everything as it was; the map is then not kept.
  AddResult add(const WindowMap& map);
  /// Empties window and map.
  void reset();

  [[nodiscard]] const Window& window() const { return window_; }
  /// Origin and size; those of the map with the newest stamp (R7).
  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] FusedView view() const;

  /// The fused voxels as a brick map (R6): the room it takes, and the writing of it.
  [[nodiscard]] BrickMapShape shape() const;
  void write(const BrickMapArrays& out) const;

 private:
  // What changes in a tick.
  struct Change {
    const WindowMap* added;
    const std::vector<WindowMap>* left;
    Grid before;
    bool moved_in_z;
  };

  // A stack of bricks.
  struct Stack {
    std::int32_t bx, by;
    std::size_t rays;   // where its columns begin in `lowest_ray_m_`
    std::size_t first;  // its first column, of all [y][x]

    // A column of it, of all [y][x].
    [[nodiscard]] std::size_t column(int c, std::int32_t n_xy) const {
      return first + static_cast<std::size_t>((c & 7) * n_xy + (c >> 3));
    }
  };

  // A voxel of one brick whose minimum left the window.
  struct StaleMinimum {
    std::uint32_t cell;
    std::uint32_t hits;  // in maps that are still to be looked at
    float least_m;       // the minimum that left: none can be lower
  };

  [[nodiscard]] Stack stack_at(std::int32_t bx, std::int32_t by) const;
  void update_stack(const Stack& stack, const Change& change);
  bool update_brick(const Int3& brick, std::uint32_t slot, const Change& change);
  void remember_brick(const Int3& brick, std::uint32_t slot, const Change& change);
  void refill(const Int3& brick, std::uint32_t slot);
  void add_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick, const CellBits& hit);
  void subtract_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick,
                      const Int3& world_brick);
  void restore_minima(const Int3& brick, std::uint32_t slot);
  // @param z of the brick, from the lowest one on
  void rebuild_masks(std::size_t z, std::uint32_t slot);
  void write_masks(const Stack& stack);
  void update_last_seen(const Stack& stack, const Change& change, bool all);
  void refresh_last_seen(const Stack& stack, std::uint64_t columns, std::int64_t newest_ns);
  void update_lowest_ray(const Stack& stack, const Change& change, bool all);
  void refresh_lowest_ray(const Stack& stack, std::uint64_t columns, float* lowest_m);
  [[nodiscard]] std::uint64_t observed_columns(const BrickMapView& map, std::int32_t bx,
                                               std::int32_t by) const;
  BrickCells cells_of(std::uint32_t slot) {
    const std::size_t begin = std::size_t{slot} * kBrickCells;
    return {hits_.data() + begin, passes_.data() + begin, min_height_m_.data() + begin};
  }
  FusedCell cell_at(std::size_t i) { return {hits_[i], passes_[i], min_height_m_[i]}; }
  [[nodiscard]] std::uint32_t slot_of(const Int3& world_brick) const;
  // What the window says of the voxel at `i` of the arrays.
  [[nodiscard]] VoxelRecord window_voxel(std::size_t i) const;

  Window window_;
  Grid grid_;
  std::int32_t min_hits_;
  std::int32_t words_;
  VoxelArray<std::uint32_t> hits_;
  VoxelArray<std::uint32_t> passes_;
  VoxelArray<float> min_height_m_;
  std::vector<std::uint8_t> live_;        // per brick: the window observes a voxel
  std::vector<std::uint16_t> hit_cells_;  // per brick: voxels with hits in the window
  std::vector<std::uint64_t> occupied_;
  std::vector<std::uint64_t> free_;
  std::vector<std::uint64_t> solid_;
  std::vector<std::uint64_t> remembered_;  // nothing in it where there is no memory
  StackMasks masks_;
  std::vector<std::int64_t> last_seen_ns_;
  std::vector<float> lowest_ray_m_;  // column_in_stacks
  std::vector<StaleMinimum> stale_;
  Memory memory_;
};

}  // namespace gvom::cpu
