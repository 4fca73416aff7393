// The masks of a column's voxels, for host and device.
#pragma once

#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom {

/// Index of the lowest set bit of a word that has one.
GVOM_HD inline std::int32_t lowest_bit_of(std::uint64_t word) {
#ifdef __CUDA_ARCH__
  return __ffsll(static_cast<long long>(word)) - 1;
#else
  return __builtin_ctzll(word);
#endif
}

/// Whether a word has at least so many set bits, 1 or more.
GVOM_HD inline bool has_bits(std::uint64_t word, std::int32_t least) {
  for (; least > 1; --least) word &= word == 0 ? 0 : word - 1;
  return word != 0;
}

/// A word of all bits from `bit` up, which may be below the word or above it.
GVOM_HD inline std::uint64_t bits_from(std::int32_t bit) {
  if (bit <= 0) return ~std::uint64_t{0};
  return bit < 64 ? ~std::uint64_t{0} << bit : 0;
}

GVOM_HD inline bool has_bit(const std::uint64_t* mask, std::int32_t bit) {
  return (mask[bit / 64] >> (bit % 64) & 1) != 0;
}

/// Index of the lowest set bit of a column's mask, or -1.
GVOM_HD inline std::int32_t lowest_bit(const std::uint64_t* mask, std::int32_t words) {
  for (std::int32_t w = 0; w < words; ++w)
    if (mask[w] != 0) return w * 64 + lowest_bit_of(mask[w]);
  return -1;
}

/// The next set bit above `bit`, or -1.
GVOM_HD inline std::int32_t next_bit(const std::uint64_t* mask, std::int32_t words, std::int32_t bit) {
  const std::int32_t word = bit / 64;
  const std::uint64_t above = bit % 64 == 63 ? 0 : mask[word] & (~std::uint64_t{0} << (bit % 64 + 1));
  if (above != 0) return word * 64 + lowest_bit_of(above);
  const std::int32_t next = lowest_bit(mask + word + 1, words - word - 1);
  return next < 0 ? -1 : (word + 1) * 64 + next;
}

}  // namespace gvom
