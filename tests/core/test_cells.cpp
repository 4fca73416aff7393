// The CPU's loops over the cells of a brick and its columns' masks: against the formulas, cell by cell.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "core/cpu/brick_cells.hpp"
#include "core/cpu/column_masks.hpp"
#include "tests/core/random.hpp"

namespace gvom::test {
namespace {

using namespace cpu;

TEST_CASE("bits of a brick's voxels are what the formulas say of each") {
  Random random(1);
  std::vector<std::uint32_t> hits(kBrickCells), passes(kBrickCells);
  for (int i = 0; i < kBrickCells; ++i) {
    const int hit = random.pick({0, 1, 2, 3, 100, (1 << 25) - 1});
    hits[i] = static_cast<std::uint32_t>(hit);
    passes[i] =
        static_cast<std::uint32_t>(random.pick({0, 1, 64 * hit - 1, 64 * hit, 64 * hit + 1, INT32_MAX}));
    if (hit == 0 && passes[i] > INT32_MAX) passes[i] = 0;
  }
  const std::uint32_t min_hits = 2;
  const VoxelBits bits = voxel_bits(hits.data(), passes.data(), static_cast<std::int32_t>(min_hits));
  for (std::size_t i = 0; i < kBrickCells; ++i) {
    CAPTURE(i, hits[i], passes[i]);
    CHECK(has_bit(bits.occupied, i) == is_occupied(hits[i], min_hits));
    CHECK(has_bit(bits.free, i) == is_free(hits[i], passes[i], min_hits));
    CHECK(has_bit(bits.solid, i) == (is_occupied(hits[i], min_hits) && !is_worn(hits[i], passes[i])));
  }
}

TEST_CASE("a lookup value of 0 or more is a hit, one below -1 a pass, and -1 neither") {
  Random random(2);
  std::vector<std::int32_t> lookup(kBrickCells);
  std::vector<std::uint16_t> numbers(kBrickCells);
  for (int i = 0; i < kBrickCells; ++i) {
    lookup[i] = random.pick({0, 5, INT32_MAX, -1, -2, -300, INT32_MIN});
    numbers[i] = static_cast<std::uint16_t>(random.pick({0, 1, 0x100, 0xFFFF}));
  }
  const ObservedBits observed = observed_in(lookup.data());
  const CellBits set = set_in(numbers.data());
  for (std::size_t i = 0; i < kBrickCells; ++i) {
    CAPTURE(i, lookup[i]);
    CHECK(has_bit(observed.hit, i) == (lookup[i] >= 0));
    CHECK(has_bit(observed.passed, i) == (lookup[i] < -1));
    CHECK(has_bit(set, i) == (numbers[i] != 0));
  }
}

TEST_CASE("columns' words get the bytes of the bricks that changed, and keep the others") {
  constexpr std::ptrdiff_t kWords = 2, kRow = 20 * kWords;
  Random random(3);
  StackMasks masks;
  for (CellBits& brick : masks.occupied.bricks)
    for (std::uint8_t& byte : brick) byte = static_cast<std::uint8_t>(random.integer(0, 255));
  for (const std::size_t brick : {0, 3, 7}) masks.change(brick);
  std::vector<std::uint64_t> words(kBrickEdge * kRow, 0x1122334455667788);
  write_words(masks.occupied.bricks.data(), masks.changed[0], words.data(), {kWords, kRow});
  for (int x = 0; x < kBrickEdge; ++x)
    for (int y = 0; y < kBrickEdge; ++y)
      for (std::size_t brick = 0; brick < 8; ++brick) {
        const std::uint64_t word = words[static_cast<std::size_t>(x * kWords + y * kRow)];
        const bool changed = brick == 0 || brick == 3 || brick == 7;
        const auto kept = static_cast<std::uint8_t>(0x1122334455667788 >> (8 * brick));
        const std::uint8_t expected =
            changed ? masks.occupied.bricks[brick][static_cast<std::size_t>(x * kBrickEdge + y)] : kept;
        CHECK(static_cast<std::uint8_t>(word >> (8 * brick)) == expected);
      }
  CHECK(std::count(words.begin(), words.end(), 0x1122334455667788) >= kBrickEdge * kRow - kBrickColumns);
}

}  // namespace
}  // namespace gvom::test
