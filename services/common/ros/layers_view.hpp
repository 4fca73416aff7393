// Layers to be sent, wherever they lie: in a chunk of the bus or in gvom-map's own memory.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/format/grid.hpp"
#include "core/format/layers.hpp"

namespace gvom::ros {

/// In the order of LayerId.
inline constexpr std::array<std::string_view, kLayers> kLayerNames = {"height",
                                                                      "inferred_height",
                                                                      "slope_x",
                                                                      "slope_y",
                                                                      "slope",
                                                                      "roughness",
                                                                      "obstacle_density",
                                                                      "negative_delta",
                                                                      "clearance",
                                                                      "last_seen",
                                                                      "flags",
                                                                      "visibility",
                                                                      "cost"};

constexpr std::string_view name_of(LayerId id) {
  return kLayerNames[static_cast<std::size_t>(id)];
}

/// The layer of that name; nothing if there is none.
constexpr std::optional<LayerId> layer_of(std::string_view name) {
  for (std::size_t i = 0; i < kLayerNames.size(); ++i)
    if (kLayerNames[i] == name) return static_cast<LayerId>(i);
  return std::nullopt;
}

/// Arrays of size x size values, [y][x] from the grid's origin; frame odom. They are somebody else's.
struct LayersView {
  Grid grid;
  PoseRecord T_odom_base{};  ///< At the stamp.
  std::int64_t stamp_ns = 0;
  std::array<const void*, kLayers> arrays{};

  [[nodiscard]] std::size_t columns() const { return grid.columns(); }

  /// Value of a column as a float; flags, visibility and cost are whole numbers.
  [[nodiscard]] float value(LayerId id, std::size_t column) const {
    const void* array = arrays[static_cast<std::size_t>(id)];
    if (layer_value_bytes(id) == 1) return static_cast<const std::uint8_t*>(array)[column];
    return static_cast<const float*>(array)[column];
  }

  /// The corner of column (0, 0) with the least x and y, metres in odom.
  [[nodiscard]] double corner_m(std::size_t axis) const {
    return grid.origin[axis] * grid.resolution_m[axis];
  }
};

}  // namespace gvom::ros
