// What the reports of a comparison with the GPU have in common.
#pragma once

#include <string>

#include "tools/benchmark/gpu.hpp"
#include "tools/benchmark/text.hpp"

namespace gvom::bench {

/// "p50 / p99", ms.
inline std::string times(const Samples& samples) {
  return text("%.3f / %.3f", samples.quantile_ms(0.5), samples.quantile_ms(0.99));
}

/// Of the medians.
inline double ratio(const Samples& samples, const Samples& other) {
  return samples.quantile_ms(0.5) / other.quantile_ms(0.5);
}

/// Null where the row did not fit.
inline const DeviceTimes* device_of(const TickRow& row) {
  return row.cuda ? &*row.cuda->device : nullptr;
}

}  // namespace gvom::bench
