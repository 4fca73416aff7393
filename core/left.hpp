// Whether what stood in a voxel has left it (R11), for host and device.
#pragma once

#include "core/cell.hpp"

namespace gvom {

inline constexpr std::int64_t kQuiet_ns = 180'000'000;   ///< What isn't hit for so long may have left.
inline constexpr std::int64_t kJustNow_ns = 80'000'000;  ///< Hits this new, beside it, say that it stays.
inline constexpr std::int64_t kLooksBack_ns = 1'000'000'000;  ///< An older hit is as one of that age.
inline constexpr std::uint64_t kMissed = 4;  ///< So many hits would have come, had it still been there.
inline constexpr std::uint64_t kSurelyMissed = 16;  ///< Likewise, whatever is hit beside it.

/// What the newest rays say of an occupied voxel.
enum class Presence { there, quiet, left };

/// Whether one of the newest maps has a hit in the voxel or beside it, in its layer. @param Maps those of the
/// window, newest first: `count()`, `stamp_ns(i)` and `lookup(i, world)`, a map's lookup value of a world
/// voxel
template <class Maps>
GVOM_HD bool is_hit_around(const Maps& maps, const Int3& world) {
  for (std::int32_t i = 0; i < maps.count() && maps.stamp_ns(0) - maps.stamp_ns(i) < kJustNow_ns; ++i)
    for (std::int32_t dy = -1; dy <= 1; ++dy)
      for (std::int32_t dx = -1; dx <= 1; ++dx)
        if (maps.lookup(i, {world[0] + dx, world[1] + dy, world[2]}) >= 0) return true;
  return false;
}

/// `left`: rays pass where something was hit before. `quiet`: it wasn't hit lately.
/// @param hits, passes of the fused voxel
template <class Maps>
GVOM_HD Presence presence(const Maps& maps, const Int3& world, std::uint32_t hits, std::uint32_t passes) {
  const std::int64_t newest_ns = maps.stamp_ns(0);
  std::int64_t passed_ns = 0, hit_ns = newest_ns - kLooksBack_ns;
  std::uint64_t since = 0, now = 0;  // passes: of newer maps, and of those of the stamp in work
  for (std::int32_t i = 0; i < maps.count() && maps.stamp_ns(i) > hit_ns; ++i) {
    const std::int32_t lookup = maps.lookup(i, world);
    if (i > 0 && maps.stamp_ns(i) != maps.stamp_ns(i - 1)) {
      since += now;
      now = 0;
    }
    if (lookup >= 0) {
      hit_ns = maps.stamp_ns(i);
      now = 0;
      break;
    }
    if (since + now == 0) passed_ns = maps.stamp_ns(i);
    now += free_passes(lookup);
  }
  since += now;
  const std::uint64_t missed = since * hits, before = std::uint64_t{hits} + passes - since;
  const bool passed = since != 0 && passed_ns - hit_ns >= kQuiet_ns && missed >= kMissed * before;
  if (passed && (missed >= kSurelyMissed * before || !is_hit_around(maps, world))) return Presence::left;
  return newest_ns - hit_ns >= kQuiet_ns ? Presence::quiet : Presence::there;
}

}  // namespace gvom
