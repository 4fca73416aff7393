// One bit for each of the 512 cells of a brick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/cell.hpp"

namespace gvom::cpu {

/// Byte c is column c (x * 8 + y), its bit z the cell.
using CellBits = std::array<std::uint8_t, kBrickCells / 8>;

/// Calls `change(out word, in words ..)` for 64 cells at a time.
template <class Change, class... Bits>
void change_words(CellBits& out, Change&& change, const Bits&... in) {
  for (std::size_t i = 0; i < out.size(); i += sizeof(std::uint64_t)) {
    const auto word_of = [i](const CellBits& bits) {
      std::uint64_t word;
      std::memcpy(&word, bits.data() + i, sizeof word);
      return word;
    };
    std::uint64_t word = word_of(out);
    change(word, word_of(in)...);
    std::memcpy(out.data() + i, &word, sizeof word);
  }
}

inline CellBits operator&(const CellBits& a, const CellBits& b) {
  CellBits both = a;
  change_words(
      both, [](std::uint64_t& word, std::uint64_t other) { word &= other; }, b);
  return both;
}
inline CellBits operator|(const CellBits& a, const CellBits& b) {
  CellBits any = a;
  change_words(
      any, [](std::uint64_t& word, std::uint64_t other) { word |= other; }, b);
  return any;
}
/// Those of a that are not in b.
inline CellBits without(const CellBits& a, const CellBits& b) {
  CellBits rest = a;
  change_words(
      rest, [](std::uint64_t& word, std::uint64_t other) { word &= ~other; }, b);
  return rest;
}

inline void set_bit(CellBits& bits, std::size_t cell) {
  bits[cell / 8] = static_cast<std::uint8_t>(bits[cell / 8] | 1U << (cell % 8));
}
inline bool has_bit(const CellBits& bits, std::size_t cell) {
  return (bits[cell / 8] >> (cell % 8) & 1) != 0;
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

}  // namespace gvom::cpu
