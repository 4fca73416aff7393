// A vector of 32-bit numbers, a lane for each: what the compiler's vectors have no words for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cpu/clones.hpp"

#ifdef GVOM_CLONE_FOR
#include <immintrin.h>
#endif

namespace gvom::cpu {

inline constexpr int kMostLanes = 16;

/// As many lanes as the instruction set takes at once.
template <int kLanes>
struct Vectors {
  typedef std::int32_t Ints __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
  typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
  typedef double Doubles __attribute__((vector_size(kLanes * sizeof(double))));
  typedef std::int64_t Longs __attribute__((vector_size(kLanes * sizeof(std::int64_t))));
};

template <int kLanes>
using Ints = typename Vectors<kLanes>::Ints;
template <int kLanes>
using Doubles = typename Vectors<kLanes>::Doubles;

/// 0, 1, 2, ..
template <int kLanes>
GVOM_INLINE Ints<kLanes> lane_numbers() {
  Ints<kLanes> lanes{};
  for (int i = 0; i < kLanes; ++i) lanes[i] = i;
  return lanes;
}

template <int kLanes>
GVOM_INLINE Ints<kLanes> all(std::int32_t value) {
  return Ints<kLanes>{} + value;
}

/// Out of halves, as the compiler has no registers for sixteen doubles.
template <int kLanes>
GVOM_INLINE Doubles<kLanes> all_doubles(double value) {
  constexpr int kHalf = kLanes / 2;
  const Doubles<kHalf> half = Doubles<kHalf>{} + value;
  Doubles<kLanes> doubles;
  __builtin_memcpy(&doubles, &half, sizeof half);
  __builtin_memcpy(reinterpret_cast<char*>(&doubles) + sizeof half, &half, sizeof half);
  return doubles;
}

/// Lane i: what is in lane i + kBy of `lanes` and then of `after`.
template <int kLanes, int kBy>
GVOM_INLINE Ints<kLanes> moved_down(Ints<kLanes> lanes, Ints<kLanes> after) {
  return __builtin_shuffle(lanes, after, lane_numbers<kLanes>() + kBy);
}

template <int kLanes>
GVOM_INLINE bool any_set(Ints<kLanes> value) {
  std::int32_t any = 0;
  for (int i = 0; i < kLanes; ++i) any |= value[i];
  return any != 0;
}

template <int kLanes>
GVOM_INLINE Ints<kLanes> load(const void* from) {
  Ints<kLanes> lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

template <int kLanes>
GVOM_INLINE void store(void* to, Ints<kLanes> lanes) {
  __builtin_memcpy(to, &lanes, sizeof lanes);
}

/// Lane i: what is in the lane of that number, modulo kLanes.
template <int kLanes>
GVOM_INLINE Ints<kLanes> picked(Ints<kLanes> lanes, Ints<kLanes> numbers) {
  return __builtin_shuffle(lanes, numbers);
}

/// The numbers of the set bits, then kLanes.
template <int kLanes>
Ints<kLanes> set_bits(std::uint32_t bits);
/// Bit i: lane i of a is not that of b.
template <int kLanes>
std::uint32_t unequal(Ints<kLanes> a, Ints<kLanes> b);
/// Bit i: it is less.
template <int kLanes>
GVOM_INLINE std::uint32_t less(Ints<kLanes> a, Ints<kLanes> b) {
  const Ints<kLanes> is_less = a < b;
  std::uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= static_cast<std::uint32_t>(is_less[i] & 1) << i;
  return bits;
}

#ifdef __SSE2__
template <>
GVOM_INLINE std::uint32_t less<4>(Ints<4> a, Ints<4> b) {
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps((Vectors<4>::Floats)(a < b)));
}
#endif

// Of 8 and 16 lanes only. Builtins: an intrinsic has a target of its own and cannot be inlined into a
// template.
#ifdef GVOM_CLONE_FOR
template <>
GVOM_INLINE Ints<16> set_bits<16>(std::uint32_t bits) {
  return __builtin_ia32_compresssi512_mask(lane_numbers<16>(), all<16>(16), static_cast<std::uint16_t>(bits));
}
template <>
GVOM_INLINE std::uint32_t unequal<16>(Ints<16> a, Ints<16> b) {
  return __builtin_ia32_cmpd512_mask(a, b, 4, 0xFFFF);
}
template <>
GVOM_INLINE std::uint32_t less<16>(Ints<16> a, Ints<16> b) {
  return __builtin_ia32_cmpd512_mask(a, b, 1, 0xFFFF);
}

struct SetBits {
  alignas(32) std::int32_t of[256][8];
  constexpr SetBits() : of{} {
    for (int byte = 0; byte < 256; ++byte)
      for (int bit = 0, n = 0; n < 8; ++bit)
        if (bit >= 8 || (byte >> bit & 1) != 0) of[byte][n++] = bit < 8 ? bit : 8;
  }
};
inline constexpr SetBits kSetBits;

template <>
GVOM_INLINE Ints<8> set_bits<8>(std::uint32_t bits) {
  Ints<8> numbers;
  __builtin_memcpy(&numbers, kSetBits.of[bits], sizeof numbers);
  return numbers;
}
template <>
GVOM_INLINE std::uint32_t unequal<8>(Ints<8> a, Ints<8> b) {
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256((Vectors<8>::Floats)(a != b)));
}
template <>
GVOM_INLINE std::uint32_t less<8>(Ints<8> a, Ints<8> b) {
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256((Vectors<8>::Floats)(a < b)));
}
#endif

}  // namespace gvom::cpu
