// How many floats a point of a .bin file has. The format does not say: KITTI writes four, nuScenes five,
// Waymo six.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "services/ingest/fragments.hpp"
#include "services/ingest/hits.hpp"

namespace gvom::ingest {

/// Those that are read.
inline constexpr std::size_t kMinFloats = 4;
inline constexpr std::size_t kMaxFloats = 6;

struct FloatsJudgement {
  enum class Kind {
    unknown,       ///< Too few values that are not zero.
    found,         ///< `floats` a point, 2 to 8, beyond doubt.
    three_or_six,  ///< Pairs of points of three floats look much like points of six.
    none,          ///< Enough values, and no such number fits them.
  };
  Kind kind = Kind::unknown;
  std::size_t floats = 0;
  bool empty = true;  ///< There is no value but zeros.
};

/// Judges by the values alone, whatever their order: those of one column (x, y, z, an intensity, a ring) are
/// alike in sign, size and in being whole numbers, and columns differ. Looks at some 13,000 of them.
/// Allocates nothing.
FloatsJudgement judge_floats(Bytes file);

/// An error if `file`, taken as points of `floats` floats, is not what a lidar writes: its values say another
/// number, or coordinates are not metres.
tl::expected<void, std::string> check_floats(Bytes file, std::size_t floats);

Hits count_hits(Bytes file, std::size_t floats);

}  // namespace gvom::ingest
