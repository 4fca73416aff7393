// Columns and voxels as point clouds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/format/brick_map.hpp"
#include "services/common/ros/layers_view.hpp"

namespace gvom::ros {

/// sensor_msgs/PointCloud2 of the columns that have a height: their centres, z is the height, and the chosen
/// layers; all fields float32. Replaces what is in `out`.
void write_columns_cloud(const LayersView& layers, const std::vector<LayerId>& chosen,
                         const std::string& frame, std::vector<std::uint8_t>& out);

/// sensor_msgs/PointCloud2 of the voxels with hits: their centres, and `density`, hits / (hits + passes),
/// above 0 to 1; all fields float32. The map's indices are followed: they are to be right (validate_deep).
void write_voxels_cloud(const BrickMapView& map, const std::string& frame, std::vector<std::uint8_t>& out);

}  // namespace gvom::ros
