// The masks of the columns of a stack of bricks: a byte of each word for each brick (little-endian, as all
// machines with CUDA are).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/cpu/cell_bits.hpp"

namespace gvom::cpu {

inline constexpr std::size_t kMostBricks = 32;  // in a stack: 256 voxels
inline constexpr std::size_t kMostWords = kMostBricks / 8;

struct StackBits {
  std::array<CellBits, kMostBricks> bricks{};
};

/// What is to be written of a stack.
struct StackMasks {
  StackBits occupied, free, solid, remembered;
  std::array<std::uint64_t, kMostWords>
      changed{};  ///< Of a column's words: the bytes of bricks that changed.
  bool any_changed = false;

  void begin() {
    changed = {};
    any_changed = false;
  }
  void change(std::size_t brick) {
    changed[brick / 8] |= std::uint64_t{0xFF} << (brick % 8 * 8);
    any_changed = true;
  }
};

/// From a word of a column to that of the next one along an axis.
struct WordSteps {
  std::ptrdiff_t x, y;
};

/// Writes the changed bytes of a word of each of the 64 columns.
/// @param bricks the eight that the word is of
void write_words(const CellBits* bricks, std::uint64_t changed, std::uint64_t* first, const WordSteps& step);

}  // namespace gvom::cpu
