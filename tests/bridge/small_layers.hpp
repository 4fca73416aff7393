// Layers of a few columns, with values that can be told from each other.
#pragma once

#include <array>
#include <vector>

#include "services/common/ros/layers_view.hpp"

namespace gvom::test {

/// size_xy x size_xy columns of 0.5 m, the first at (-8 voxels, 16 voxels). Float layer l of column i is
/// 100 l + i, byte layer l is l + i, but the height of column 1 and of column 2 is unknown.
class SmallLayers {
 public:
  explicit SmallLayers(int size_xy) {
    const auto columns = static_cast<std::size_t>(size_xy) * size_xy;
    view.grid.origin = {-8, 16, -8};
    view.grid.size = {size_xy, size_xy, 16};
    view.grid.resolution_m = {0.5, 0.5, 0.25};
    view.T_odom_base = {{1.5, -2.5, 3.5}, {0, 0, 0.6, 0.8}};
    view.stamp_ns = 12'000'000'034;
    for (std::size_t l = 0; l < kLayers; ++l) {
      if (layer_value_bytes(static_cast<LayerId>(l)) == 4) {
        floats[l].resize(columns);
        for (std::size_t i = 0; i < columns; ++i) floats[l][i] = static_cast<float>(100 * l + i);
        view.arrays[l] = floats[l].data();
      } else {
        bytes[l].resize(columns);
        for (std::size_t i = 0; i < columns; ++i) bytes[l][i] = static_cast<std::uint8_t>(l + i);
        view.arrays[l] = bytes[l].data();
      }
    }
    floats[0][1] = floats[0][2] = kUnknown;
  }
  SmallLayers(const SmallLayers&) = delete;
  SmallLayers& operator=(const SmallLayers&) = delete;

  std::array<std::vector<float>, kLayers> floats;
  std::array<std::vector<std::uint8_t>, kLayers> bytes;
  ros::LayersView view;
};

}  // namespace gvom::test
