// How fields of packed data name their types.
#pragma once

#include <cstdint>

namespace gvom::ros {

/// Of foxglove_msgs/PackedElementField.
namespace foxglove {
inline constexpr std::uint8_t kUint8 = 1;
inline constexpr std::uint8_t kFloat32 = 7;
}  // namespace foxglove

/// Of sensor_msgs/PointField.
namespace point_field {
inline constexpr std::uint8_t kFloat32 = 7;
}  // namespace point_field

}  // namespace gvom::ros
