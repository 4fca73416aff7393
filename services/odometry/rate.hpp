// `--rate N|max`.
#pragma once

#include <optional>
#include <string>

namespace gvom::odometry {

struct Rate {
  double factor = 1.0;    ///< Times the recorded pace.
  bool lossless = false;  ///< "max": as fast as the slowest reader takes it.
};

/// Nothing unless `text` is "max" or a number above 0 and at most 1000.
std::optional<Rate> parse_rate(const std::string& text);

}  // namespace gvom::odometry
