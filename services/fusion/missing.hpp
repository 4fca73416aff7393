// Which lidars are missing from the map, as Layers tells it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/window.hpp"

namespace gvom::fusion {

/// True if the window has no map of the lidar, or none newer than `missing_after_ns` before the newest map of
/// all. It asks no clock but the maps' stamps: a replay says the same at any speed.
inline bool is_missing(const Window& window, int lidar, std::int64_t missing_after_ns) {
  const auto& maps = window.maps();  // newest first
  const auto newest =
      std::find_if(maps.begin(), maps.end(), [lidar](const WindowMap& map) { return map.lidar == lidar; });
  return newest == maps.end() || newest->view.stamp_ns < maps.front().view.stamp_ns - missing_after_ns;
}

}  // namespace gvom::fusion
