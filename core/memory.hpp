// What is remembered of a voxel whose maps have left the window (R17), for host and device.
//
// Maps leave in no order, so everything here gives the same in any order: of two beats the newer one
// counts, within a beat counts add up to a limit, and heights are minima.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/cell.hpp"

namespace gvom {

/// What memory knows of time: a beat of 2^29 ns, 0.54 s.
inline constexpr int kBeatBits = 29;

/// The longest memory, in its beats: the age of what is to be forgotten next still fits into a byte.
inline constexpr std::int32_t kMostBeats = 127;

/// The beat in which a stamp lies. What is remembered has its last eight bits.
GVOM_HD inline std::int64_t beat_of(std::int64_t stamp_ns) {
  return stamp_ns >> kBeatBits;
}

/// How long something is remembered, in whole beats of the memory, at most `kMostBeats`; 0: nothing is.
inline std::int32_t beats_remembered(double max_age_s) {
  const double beats = std::ceil(max_age_s * 1e9 / (std::int64_t{1} << kBeatBits));
  return beats < kMostBeats ? static_cast<std::int32_t>(beats) : kMostBeats;
}

/// Beats from one to another that is not older. Both are known by their last eight bits.
GVOM_HD inline std::uint8_t beats_between(std::uint8_t older, std::uint8_t newer) {
  return static_cast<std::uint8_t>(newer - older);
}

/// Time from the beginning of a beat to a stamp, nanoseconds.
GVOM_HD inline std::int64_t time_since(std::uint8_t beat, std::int64_t stamp_ns) {
  constexpr std::int64_t kRest = (std::int64_t{1} << kBeatBits) - 1;
  const std::int64_t age = beats_between(beat, static_cast<std::uint8_t>(beat_of(stamp_ns)));
  return (age << kBeatBits) + (stamp_ns & kRest);
}

/// The sum, no more than `most`.
GVOM_HD inline std::uint32_t saturated(std::uint64_t sum, std::uint32_t most) {
  return sum < most ? static_cast<std::uint32_t>(sum) : most;
}

/// The records of a voxel in the newest beat that has one.
struct RememberedHits {
  float min_height_m;  ///< Of something.
  std::uint32_t bits;  ///< Passes, hits and the beat, from the top: 12, 12 and 8 bits. 0: nothing.

  static constexpr std::uint32_t kMost = 0xFFF;

  [[nodiscard]] GVOM_HD std::uint32_t passes() const { return bits >> 20; }
  [[nodiscard]] GVOM_HD std::uint32_t hits() const { return bits >> 8 & kMost; }
  [[nodiscard]] GVOM_HD std::uint8_t beat() const { return static_cast<std::uint8_t>(bits); }
};

inline constexpr RememberedHits kNoHits = {kNoHeight_m, 0};

/// Adds a record of a map that left. @param beat its map's, @param now that of the newest stamp
GVOM_HD inline RememberedHits with_record(RememberedHits cell, const VoxelRecord& record, std::uint8_t beat,
                                          std::uint8_t now) {
  if (cell.bits == 0 || cell.beat() != beat) {
    if (cell.bits != 0 && beats_between(cell.beat(), now) < beats_between(beat, now)) return cell;
    cell = kNoHits;
  }
  const std::uint32_t hits = saturated(std::uint64_t{cell.hits()} + record.hits, RememberedHits::kMost);
  const std::uint32_t passes = saturated(std::uint64_t{cell.passes()} + record.passes, RememberedHits::kMost);
  return {lower(cell.min_height_m, record.min_height_m), passes << 20 | hits << 8 | beat};
}

/// The passes of a voxel's maps without a hit there, in the newest beat that has one: passes and, in the
/// low byte, the beat. 0: nothing.
using RememberedPasses = std::uint16_t;
inline constexpr std::uint32_t kMostPasses = 255;

/// Of a voxel in a map, as many as can be added at a time.
GVOM_HD inline std::uint16_t rememberable(std::uint32_t passes) {
  return static_cast<std::uint16_t>(passes < kMostPasses ? passes : kMostPasses);
}
GVOM_HD inline std::uint32_t passes_in(RememberedPasses cell) {
  return cell >> 8;
}
GVOM_HD inline std::uint8_t beat_in(RememberedPasses cell) {
  return static_cast<std::uint8_t>(cell);
}

/// Adds `rememberable` passes of a map that left; without branches, since a CPU does many at
/// once.
GVOM_HD inline RememberedPasses with_passes(RememberedPasses cell, std::uint16_t passes, std::uint8_t beat,
                                            std::uint8_t now) {
  const auto had = static_cast<std::uint16_t>(cell >> 8);
  const auto own_beat = static_cast<std::uint16_t>(cell & 0xFF);
  const auto own_age = static_cast<std::uint16_t>((now - own_beat) & 0xFF);
  const auto age = static_cast<std::uint16_t>((now - beat) & 0xFF);
  const bool same = own_beat == beat;
  const auto sum = static_cast<std::uint16_t>(passes + (same ? had : 0));
  const std::uint16_t most = sum < kMostPasses ? sum : static_cast<std::uint16_t>(kMostPasses);
  const bool counts =
      (static_cast<int>(passes != 0) & (static_cast<int>(had == 0) | static_cast<int>(age <= own_age))) != 0;
  return counts ? static_cast<RememberedPasses>(most << 8 | beat) : cell;
}

/// Of a column of a brick, bit z: the voxels whose passes say something. Those of the lowest voxel that the
/// map observed in the whole column do not: the ray was somewhere in it, and the ground may be below.
/// @param lower the map has observed a voxel of the column in a lower brick
GVOM_HD inline std::uint8_t telling_passes(std::uint8_t hit, std::uint8_t passed, bool lower) {
  const unsigned observed = static_cast<unsigned>(hit) | passed;
  const unsigned lowest = observed & (0U - observed);
  return static_cast<std::uint8_t>(lower ? passed : passed & ~lowest);
}

/// What a voxel that the window does not observe shows: hits and passes of its newest beat. 0 and 0:
/// nothing.
GVOM_HD inline VoxelRecord shown_voxel(const RememberedHits& hits, RememberedPasses passes,
                                       std::uint8_t now) {
  const bool passed = passes_in(passes) != 0;
  if (hits.bits == 0) return {0, passes_in(passes), kNoHeight_m};
  const std::uint8_t hit_age = beats_between(hits.beat(), now);
  const std::uint8_t pass_age = beats_between(beat_in(passes), now);
  if (passed && pass_age < hit_age) return {0, passes_in(passes), kNoHeight_m};
  const std::uint32_t also = passed && pass_age == hit_age ? passes_in(passes) : 0;
  return {hits.hits(), hits.passes() + also, hits.min_height_m};
}

/// How much higher a map's rays are remembered in a stack of bricks: what an error of its attitude may have
/// lowered them by, for each metre from the middle of its grid, near which the vehicle was.
inline constexpr double kDoubtPerRange = 0.004;
GVOM_HD inline float doubt_of_rays_m(const Grid& grid, std::int32_t bx, std::int32_t by) {
  const Int3 n = grid.bricks();
  const double dx = bx - grid.origin[0] / kBrickEdge + 0.5 - 0.5 * n[0];
  const double dy = by - grid.origin[1] / kBrickEdge + 0.5 - 0.5 * n[1];
  return static_cast<float>(kDoubtPerRange *
                            (kBrickEdge * grid.resolution_m[0] * std::sqrt(dx * dx + dy * dy)));
}

/// Rays are remembered in spans of a quarter of the time, five of them: those of the last four are all there.
inline constexpr std::int32_t kSpans = 5;
GVOM_HD inline std::int32_t beats_of_span(std::int32_t beats_remembered) {
  return (beats_remembered + 3) / 4;
}
/// The span of a beat, rounded towards minus infinity.
GVOM_HD inline std::int64_t span_of(std::int64_t beat, std::int32_t beats_remembered) {
  const std::int64_t length = beats_of_span(beats_remembered);
  return beat >= 0 ? beat / length : -((-beat + length - 1) / length);
}

}  // namespace gvom
