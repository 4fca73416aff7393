#include "core/cpu/brick_cells.hpp"

#include "core/cpu/clones.hpp"
#include "core/cpu/lanes.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace gvom::cpu {

namespace {

constexpr int kCellsAtATime = 16;

void put(std::uint32_t sixteen, std::size_t cell, CellBits& bits) {
  bits[cell / 8] = static_cast<std::uint8_t>(sixteen);
  bits[cell / 8 + 1] = static_cast<std::uint8_t>(sixteen >> 8);
}

template <int kLanes>
GVOM_INLINE ObservedBits observed_with_lanes(const std::int32_t* lookup) {
  ObservedBits bits;
  for (std::size_t cell = 0; cell < kBrickCells; cell += kCellsAtATime) {
    std::uint32_t hit = 0, passed = 0;
    for (int k = 0; k < kCellsAtATime; k += kLanes) {
      const Ints<kLanes> value = load<kLanes>(lookup + cell + k);
      hit |= less<kLanes>(all<kLanes>(-1), value) << k;
      passed |= less<kLanes>(value, all<kLanes>(-1)) << k;
    }
    put(hit, cell, bits.hit);
    put(passed, cell, bits.passed);
  }
  return bits;
}

// Passes > 64 hits is the same as (passes - 1) / 64 >= hits, rounded down, which stays within 32 bits.
static_assert(kMostPassesPerHit == 64);

template <int kLanes>
GVOM_INLINE VoxelBits voxel_bits_with_lanes(const std::uint32_t* hits, const std::uint32_t* passes,
                                            std::int32_t min_hits) {
  VoxelBits bits;
  for (std::size_t cell = 0; cell < kBrickCells; cell += kCellsAtATime) {
    std::uint32_t occupied = 0, observed = 0, solid = 0;
    for (int k = 0; k < kCellsAtATime; k += kLanes) {
      const Ints<kLanes> hit = load<kLanes>(hits + cell + k), passed = load<kLanes>(passes + cell + k);
      occupied |= less<kLanes>(all<kLanes>(min_hits - 1), hit) << k;
      observed |= less<kLanes>(all<kLanes>(0), hit | passed) << k;
      solid |= less<kLanes>((passed - 1) >> 6, hit) << k;
    }
    put(occupied, cell, bits.occupied);
    put(observed & ~occupied, cell, bits.free);
    put(occupied & solid, cell, bits.solid);
  }
  return bits;
}

#ifdef GVOM_CLONE_FOR
GVOM_CLONE_FOR("arch=x86-64-v4")
ObservedBits observed(const std::int32_t* lookup) {
  return observed_with_lanes<16>(lookup);
}
GVOM_CLONE_FOR("arch=x86-64-v3")
ObservedBits observed(const std::int32_t* lookup) {
  return observed_with_lanes<8>(lookup);
}
GVOM_CLONE_FOR("arch=x86-64-v4")
VoxelBits voxels(const std::uint32_t* hits, const std::uint32_t* passes, std::int32_t min_hits) {
  return voxel_bits_with_lanes<16>(hits, passes, min_hits);
}
GVOM_CLONE_FOR("arch=x86-64-v3")
VoxelBits voxels(const std::uint32_t* hits, const std::uint32_t* passes, std::int32_t min_hits) {
  return voxel_bits_with_lanes<8>(hits, passes, min_hits);
}
#endif

GVOM_CLONE_DEFAULT
ObservedBits observed(const std::int32_t* lookup) {
  return observed_with_lanes<4>(lookup);
}
GVOM_CLONE_DEFAULT
VoxelBits voxels(const std::uint32_t* hits, const std::uint32_t* passes, std::int32_t min_hits) {
  return voxel_bits_with_lanes<4>(hits, passes, min_hits);
}

GVOM_CLONES void add_passes(const std::int32_t* lookup, std::uint32_t* passes) {
  GVOM_INDEPENDENT
  for (int i = 0; i < kBrickCells; ++i) passes[i] += free_passes(lookup[i]);
}

GVOM_CLONES void subtract_passes(const std::int32_t* lookup, std::uint32_t* passes) {
  GVOM_INDEPENDENT
  for (int i = 0; i < kBrickCells; ++i) passes[i] -= free_passes(lookup[i]);
}

}  // namespace

ObservedBits observed_in(const std::int32_t* lookup) {
  return observed(lookup);
}

VoxelBits voxel_bits(const std::uint32_t* hits, const std::uint32_t* passes, std::int32_t min_hits) {
  return voxels(hits, passes, min_hits);
}

void add_free_passes(const std::int32_t* lookup, std::uint32_t* passes) {
  add_passes(lookup, passes);
}

void subtract_free_passes(const std::int32_t* lookup, std::uint32_t* passes) {
  subtract_passes(lookup, passes);
}

CellBits set_in(const std::uint16_t* numbers) {
  CellBits bits;
  for (std::size_t cell = 0; cell < kBrickCells; cell += kCellsAtATime) {
    std::uint32_t set = 0;
#ifdef __SSE2__
    const auto* eight = reinterpret_cast<const __m128i*>(numbers + cell);
    const __m128i none = _mm_setzero_si128();
    const __m128i low = _mm_cmpeq_epi16(_mm_loadu_si128(eight), none);
    const __m128i high = _mm_cmpeq_epi16(_mm_loadu_si128(eight + 1), none);
    set = ~static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
#else
    for (int k = 0; k < kCellsAtATime; ++k) set |= static_cast<std::uint32_t>(numbers[cell + k] != 0) << k;
#endif
    put(set, cell, bits);
  }
  return bits;
}

}  // namespace gvom::cpu
