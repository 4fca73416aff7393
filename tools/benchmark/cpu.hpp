// The CPU back end beside the obvious way and OctoMap.
#pragma once

#include <tl/expected.hpp>

#include "tools/benchmark/failure.hpp"
#include "tools/benchmark/report.hpp"

namespace gvom::bench {

/// Errors: `internal` if the passes differ from the straight loop's.
tl::expected<Report, Failure> measure_cpu(const Setting& setting, const Recording& recording, int repeats,
                                          bool octomap);

}  // namespace gvom::bench
