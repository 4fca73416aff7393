// A back end and the oracle side by side through random drives.
#pragma once

#include <cstdint>

#include "core/backend.hpp"
#include "core/format/layers.hpp"
#include "tests/core/scenario.hpp"

namespace gvom::test {

inline constexpr unsigned kAllFlags = kHard | kSoft | kNegative | kSteep | kAssumed;

/// Runs `seeds` random drives on a back end and holds everything against the oracle after every map: any
/// difference of a bit fails, with its seed. Returns the flags that were seen in any column.
unsigned race(Backend backend, const ScenarioSize& size, std::uint64_t first_seed, std::uint64_t seeds);

}  // namespace gvom::test
