// Layers as ROS's grids.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/ros/layers_view.hpp"

namespace gvom::ros {

/// `cost` (R16) as Nav2 reads it back: 255 is -1 (unknown), 254 is 100, 1 .. 252 are 1 .. 98, 0 is 0. 253,
/// which gvom does not write, is 99.
std::int8_t occupancy_of(std::uint8_t cost);

/// nav_msgs/OccupancyGrid of the layer `cost`, in `frame`, as high as the vehicle. Replaces what is in `out`.
void write_occupancy_grid(const LayersView& layers, const std::string& frame, std::vector<std::uint8_t>& out);

/// grid_map_msgs/GridMap of the chosen layers; unknown is NaN. Where the first of them is NaN a column is
/// hidden (basic_layers).
void write_grid_map(const LayersView& layers, const std::vector<LayerId>& chosen, const std::string& frame,
                    std::vector<std::uint8_t>& out);

/// foxglove_msgs/Grid of all layers: kGridCell_bytes for each column, the fields in the order of LayerId,
/// float32 and uint8.
void write_foxglove_grid(const LayersView& layers, const std::string& frame, std::vector<std::uint8_t>& out);

inline constexpr std::uint32_t kGridCell_bytes = 44;

}  // namespace gvom::ros
