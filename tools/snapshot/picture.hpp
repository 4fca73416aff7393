// What a picture of the layers is made from: plain values, wherever they came from (the bus or files).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "services/common/ros/layers_view.hpp"

namespace gvom::snapshot {

struct LidarLine {
  std::string name;
  std::uint32_t maps_in_window = 0;
  bool missing = false;         ///< One of the vehicle's lidars, but no map of it is in the window.
  double age_s = std::nan("");  ///< Its newest map against the layers' stamp; NaN: none came yet.
  std::uint64_t maps_lost = 0;
  ipc::Ground ground{};  ///< As it sees it; verdict none: not known (in a folder of files).
};

/// The layers of one stamp. The arrays are borrowed: n_xy * n_xy values indexed [y][x], +x right (forward
/// at yaw 0), +y up, in the odom frame.
struct LayersPicture {
  std::string vehicle;
  int n_xy = 0;
  std::array<std::int32_t, 3> origin_voxels{};  ///< World voxel of column (0, 0) and of the grid's floor.
  std::int32_t n_z = 0;
  double resolution_xy_m = 0.0;
  double resolution_z_m = 0.0;
  std::array<double, 3> base_position_m{};  ///< base_link in odom; NaN: not known.
  std::array<double, 4> base_orientation_xyzw = {std::nan(""), 0, 0, 0};  ///< In odom; NaN: not known.
  std::int64_t stamp_ns = 0;
  double age_s =
      std::nan("");  ///< Of the data, as ipc/freshness.hpp has it; infinite: unknown. NaN: not live.
  std::uint32_t maps_in_window = 0;
  std::vector<LidarLine> lidars;
  std::array<const float*, kFloatLayers> float_layers{};                  ///< height .. last_seen
  std::array<const std::uint8_t*, kLayers - kFloatLayers> byte_layers{};  ///< flags .. cost

  [[nodiscard]] const float* floats(LayerId id) const { return float_layers[static_cast<std::size_t>(id)]; }
  [[nodiscard]] const std::uint8_t* bytes(LayerId id) const {
    return byte_layers[static_cast<std::size_t>(id) - kFloatLayers];
  }
  /// Heading in odom, from +x to +y; NaN: not known.
  [[nodiscard]] double base_yaw_rad() const {
    const auto& [x, y, z, w] = base_orientation_xyzw;
    return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  }
  [[nodiscard]] std::size_t columns() const {
    return static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy);
  }
};

using ros::kLayerNames;  // files carry them

}  // namespace gvom::snapshot
