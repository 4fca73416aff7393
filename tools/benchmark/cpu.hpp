// The CPU back end beside the obvious way and OctoMap.
#pragma once

#include <tl/expected.hpp>

#include "core/config.hpp"
#include "tools/benchmark/failure.hpp"
#include "tools/benchmark/report.hpp"

namespace gvom::bench {

/// What of it is measured.
struct CpuSetting {
  int repeats;
  bool octomap;
  MemoryConfig memory;
};

/// Errors: `internal` if the passes differ from the straight loop's.
tl::expected<Report, Failure> measure_cpu(const Setting& setting, const Recording& recording,
                                          const CpuSetting& of);

}  // namespace gvom::bench
