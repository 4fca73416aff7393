// A stretch of the sensors' clock.
#pragma once

#include <cstdint>

namespace gvom {

/// From the first to the last moment, both within it.
struct TimeSpan {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

}  // namespace gvom
