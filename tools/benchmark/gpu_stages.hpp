// What the stages of a device's tick are held against.
#pragma once

#include <vector>

#include "tools/benchmark/gpu.hpp"

namespace gvom::bench {

struct Stage {
  const char* name;
  const Samples& times;
  double least_bytes;
  double bytes_per_s;  ///< How fast the device copies between the same memories.

  /// In which it could be done at that rate, ms.
  [[nodiscard]] double least_ms() const { return least_bytes / bytes_per_s * 1e3; }
  /// The share of that rate that the median reaches with the fewest bytes; 0 where no time was taken.
  [[nodiscard]] double share() const {
    const double s = times.quantile_ms(0.5) * 1e-3;
    return s > 0 ? least_bytes / s / bytes_per_s : 0;
  }
};

/// In their order. Tables and JSON have a row of each: parts of a stage may follow it.
inline std::vector<Stage> stages_of(const DeviceTimes& times, const cuda::CopyRates& rates) {
  const LeastBytes& least = times.least_bytes;
  return {{"upload", times.upload, least.upload, rates.to_device},
          {"fuse", times.fuse, least.fuse, rates.within_device},
          {"layers", times.layers, least.layers, rates.within_device},
          {"download", times.download, least.download, rates.to_host}};
}

/// All stages one after the other, each at its rate, ms.
inline double floor_ms(const DeviceTimes& times, const cuda::CopyRates& rates) {
  double sum_ms = 0;
  for (const Stage& stage : stages_of(times, rates)) sum_ms += stage.least_ms();
  return sum_ms;
}

}  // namespace gvom::bench
