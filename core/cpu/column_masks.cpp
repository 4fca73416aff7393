#include "core/cpu/column_masks.hpp"

#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace gvom::cpu {

namespace {

// The words of eight columns along y: byte b of the word y is byte y of row b.
struct EightWords {
  std::uint64_t words[kBrickEdge];
};

#ifdef __SSE2__
EightWords transposed(const std::uint8_t* (&rows)[kBrickEdge]) {
  const auto row = [&](int b) { return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(rows[b])); };
  const __m128i a0 = _mm_unpacklo_epi8(row(0), row(1)), a1 = _mm_unpacklo_epi8(row(2), row(3));
  const __m128i a2 = _mm_unpacklo_epi8(row(4), row(5)), a3 = _mm_unpacklo_epi8(row(6), row(7));
  const __m128i b0 = _mm_unpacklo_epi16(a0, a1), b1 = _mm_unpackhi_epi16(a0, a1);
  const __m128i b2 = _mm_unpacklo_epi16(a2, a3), b3 = _mm_unpackhi_epi16(a2, a3);
  EightWords eight;
  auto* to = reinterpret_cast<__m128i*>(eight.words);
  _mm_storeu_si128(to, _mm_unpacklo_epi32(b0, b2));
  _mm_storeu_si128(to + 1, _mm_unpackhi_epi32(b0, b2));
  _mm_storeu_si128(to + 2, _mm_unpacklo_epi32(b1, b3));
  _mm_storeu_si128(to + 3, _mm_unpackhi_epi32(b1, b3));
  return eight;
}
#else
EightWords transposed(const std::uint8_t* (&rows)[kBrickEdge]) {
  EightWords eight{};
  for (int b = 0; b < kBrickEdge; ++b)
    for (int y = 0; y < kBrickEdge; ++y) eight.words[y] |= std::uint64_t{rows[b][y]} << (8 * b);
  return eight;
}
#endif

}  // namespace

void write_words(const CellBits* bricks, std::uint64_t changed, std::uint64_t* first, const WordSteps& step) {
  if (changed == 0) return;
  for (int x = 0; x < kBrickEdge; ++x) {
    const std::uint8_t* rows[kBrickEdge];
    for (int b = 0; b < kBrickEdge; ++b) rows[b] = bricks[b].data() + x * kBrickEdge;
    const EightWords eight = transposed(rows);
    for (int y = 0; y < kBrickEdge; ++y) {
      std::uint64_t& word = first[x * step.x + y * step.y];
      word = (word & ~changed) | (eight.words[y] & changed);
    }
  }
}

}  // namespace gvom::cpu
