// What the stages of a device's tick are held against.
#pragma once

#include <array>

#include "tools/benchmark/gpu.hpp"

namespace gvom::bench {

struct Stage {
  const char* name;
  const Samples& times;
  double least_bytes;
  double bytes_per_s;  ///< How fast the device copies between the same memories.

  /// The share of that rate that the median reaches with the fewest bytes; 0 where no time was taken.
  [[nodiscard]] double share() const {
    const double s = times.quantile_ms(0.5) * 1e-3;
    return s > 0 ? least_bytes / s / bytes_per_s : 0;
  }
};

inline std::array<Stage, 4> stages_of(const DeviceTimes& times, const cuda::CopyRates& rates) {
  const LeastBytes& least = times.least_bytes;
  return {{{"upload", times.upload, least.upload, rates.to_device},
           {"fuse", times.fuse, least.fuse, rates.within_device},
           {"layers", times.layers, least.layers, rates.within_device},
           {"download", times.download, least.download, rates.to_host}}};
}

}  // namespace gvom::bench
