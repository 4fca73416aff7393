// What is remembered of maps that left the window (R17) on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cpu/brick_cells.hpp"
#include "core/cpu/huge_pages.hpp"
#include "core/fused_view.hpp"
#include "core/memory.hpp"
#include "core/window.hpp"

namespace gvom::cpu {

/// The voxels of a brick in the fused map.
struct BrickCells {
  std::uint32_t* hits;
  std::uint32_t* passes;
  float* min_height_m;
};

class Memory {
 public:
  /// Takes no room where nothing is remembered. @param most_maps that can leave the window at a time
  Memory(const Grid& grid, const MemoryConfig& config, std::size_t most_maps);

  [[nodiscard]] bool on() const { return beats_ > 0; }

  /// A map has come: what is too old now is to be forgotten, and some maps have left the window.
  void begin(const Window& window);
  /// Before the bricks of a stack, which come from the lowest up to the highest: remembers its columns.
  /// @param stack where they begin in `column_in_stacks`
  void begin_stack(std::int32_t bx, std::int32_t by, std::size_t stack, bool enters);

  /// The brick has entered the grid: nothing is remembered there.
  void forget(std::uint32_t slot);
  /// Forgets what is too old. True: some of that was shown.
  bool expire(std::uint32_t slot, const BrickCells& cells);
  /// Takes back what is shown where a map observes something.
  void give_way(std::uint32_t slot, const ObservedBits& observed, const BrickCells& cells);
  /// Remembers the brick of the map that left as the `i`th.
  void remember(std::uint32_t slot, std::size_t i, std::int32_t brick);
  /// Shows what is remembered where a map that left had observed something and the window does not now, and
  /// notes it in `bits`.
  void show(std::uint32_t slot, std::uint32_t min_hits, const BrickCells& cells, VoxelBits& bits);

  /// Voxels that show what is remembered.
  [[nodiscard]] const CellBits& shown(std::uint32_t slot) const { return bricks_[slot].shown; }
  [[nodiscard]] bool shows_any(std::uint32_t slot) const { return any_of(bricks_[slot].shown); }
  [[nodiscard]] bool shows(std::size_t cell) const {
    return has_bit(bricks_[cell / kBrickCells].shown, cell % kBrickCells);
  }
  [[nodiscard]] MemoryView view(const std::uint64_t* remembered) const {
    return {remembered,           hits_.data(),        passes_.data(),   column_beats_.data(),
            lowest_ray_m_.data(), hit_.data()->data(), hit_beats_.data()};
  }

  void reset();

 private:
  struct Brick {
    CellBits shown{};
    bool has_any = false;
    std::uint8_t oldest = 0;  // no voxel is of an older beat
  };
  // A map that left.
  struct Left {
    const BrickMapView* map;
    std::uint8_t beat;
    bool too_old;
    float* span_m;   // of its rays, or nullptr
    CellBits lower;  // of each column: voxels that it observed in lower bricks of the stack in work
  };

  [[nodiscard]] std::uint8_t now() const { return static_cast<std::uint8_t>(now_); }
  [[nodiscard]] bool is_too_old(std::uint8_t beat) const {
    return all_too_old_ || beats_between(beat, now()) > beats_;
  }
  // A beat that is too old, as far as a byte can say it.
  [[nodiscard]] std::uint8_t too_old_beat() const { return static_cast<std::uint8_t>(now_ - beats_ - 1); }
  [[nodiscard]] float* span_of_rays(std::int64_t number);
  void forget_old_columns();
  void forget_old_spans(std::int64_t before, std::int64_t span);
  void note_beat(Brick& brick, std::uint8_t beat);
  static void take_back(Brick& brick, const CellBits& taken, const BrickCells& cells);
  void tell_hits(std::uint32_t slot, const Left& left, const std::int32_t* lookup, const CellBits& hit);
  void remember_beats(const Left& left, std::uint64_t columns, std::size_t stack);

  std::int32_t beats_;
  std::int64_t now_ = 0;  // the beat of the newest stamp
  std::int32_t low_ = 0;  // the grid's lowest brick
  bool empty_ = true;
  bool all_too_old_ = false;  // all that was remembered before this tick
  std::vector<Left> left_;
  CellBits left_cells_{};  // that maps which left had observed, of the brick in work
  std::vector<Brick> bricks_;
  std::vector<CellBits> hit_;            // per brick: voxels of which hits are remembered
  VoxelArray<RememberedHits> hits_;      // of these
  VoxelArray<std::uint16_t> hit_beats_;  // of these the beat and 1, from the low byte up; else 0
  VoxelArray<RememberedPasses> passes_;
  std::vector<std::uint8_t> column_beats_;
  std::vector<float> spans_m_;       // kSpans times, column_in_stacks
  std::vector<float> lowest_ray_m_;  // the minimum of the spans
};

}  // namespace gvom::cpu
