// Loops over the 512 cells of a brick that decide how long a tick takes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/cell.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace gvom::cpu {

/// One bit for each cell of a brick. Byte c is column c (x * 8 + y), its bit z the cell.
using CellBits = std::array<std::uint8_t, kBrickCells / 8>;

/// Bits of the cells with `value >= least`.
inline CellBits at_least(const std::int32_t* values, std::int32_t least) {
  CellBits bits;
#ifdef __SSE2__
  const __m128i below = _mm_set1_epi32(least - 1);
  for (std::size_t i = 0; i < kBrickCells; i += 16) {
    const auto* quad = reinterpret_cast<const __m128i*>(values + i);
    const auto is = [&](int k) { return _mm_cmpgt_epi32(_mm_loadu_si128(quad + k), below); };
    const __m128i all = _mm_packs_epi16(_mm_packs_epi32(is(0), is(1)), _mm_packs_epi32(is(2), is(3)));
    const int two = _mm_movemask_epi8(all);
    bits[i / 8] = static_cast<std::uint8_t>(two);
    bits[i / 8 + 1] = static_cast<std::uint8_t>(two >> 8);
  }
#else
  for (std::size_t i = 0; i < kBrickCells; i += 8) {
    unsigned column = 0;
    for (unsigned k = 0; k < 8; ++k) column |= static_cast<unsigned>(values[i + k] >= least) << k;
    bits[i / 8] = static_cast<std::uint8_t>(column);
  }
#endif
  return bits;
}

/// The same of counts, which stay below 2^31.
inline CellBits at_least(const std::uint32_t* counts, std::int32_t least) {
  return at_least(reinterpret_cast<const std::int32_t*>(counts), least);
}

/// Whether any is set.
inline bool any_of(const CellBits& bits) {
  std::array<std::uint64_t, kBrickCells / 64> words;
  std::memcpy(words.data(), bits.data(), sizeof words);
  std::uint64_t any = 0;
  for (const std::uint64_t word : words) any |= word;
  return any != 0;
}

/// Calls `visit(cell)` for every set bit, in ascending order.
template <class Visit>
void for_each_cell(const CellBits& bits, Visit&& visit) {
  for (std::size_t word = 0; word < bits.size() / 8; ++word) {
    std::uint64_t rest;
    std::memcpy(&rest, bits.data() + 8 * word, sizeof rest);
    for (; rest != 0; rest &= rest - 1) visit(64 * word + static_cast<std::size_t>(__builtin_ctzll(rest)));
  }
}

/// Adds `sign` (1 or -1) times the passes of a brick's free voxels.
template <int sign>
void add_free_passes(const std::int32_t* lookup, std::uint32_t* passes) {
  for (int i = 0; i < kBrickCells; ++i) {
    const std::uint32_t free = free_passes(lookup[i]);
    passes[i] += sign > 0 ? free : 0 - free;
  }
}

}  // namespace gvom::cpu
