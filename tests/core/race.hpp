// A back end and the oracle side by side through random drives.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "core/backend.hpp"
#include "core/format/layers.hpp"
#include "tests/core/scenario.hpp"

namespace gvom::test {

inline constexpr unsigned kAllFlags = kHard | kSoft | kNegative | kSteep | kAssumed;

/// Runs `seeds` random drives on a back end and holds everything against the oracle after every map: any
/// difference of a bit fails, with its seed. Returns the flags that were seen in any column.
unsigned race(Backend backend, const ScenarioSize& size, std::uint64_t first_seed, std::uint64_t seeds);

/// How many seeds to run: all if GVOM_EVERY_SEED is set, else half of them; a third under AddressSanitizer,
/// which looks at accesses.
inline std::uint64_t seed_count(std::uint64_t count) {
#ifdef __SANITIZE_ADDRESS__
  return (count + 2) / 3;
#else
  return std::getenv("GVOM_EVERY_SEED") != nullptr ? count : (count + 1) / 2;
#endif
}

}  // namespace gvom::test
