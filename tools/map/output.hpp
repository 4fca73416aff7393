// The folder that gvom-map writes for each map: meta.json and NumPy arrays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/map/offline.hpp"

namespace gvom::tools {

/// Memory for one set of layers.
class LayerBuffers {
 public:
  explicit LayerBuffers(int size_xy);
  LayerArrays arrays();
  /// Writes each layer as `FOLDER/NAME.npy`, indexed [y][x].
  [[nodiscard]] tl::expected<void, std::string> write(const std::string& folder) const;

 private:
  std::size_t size_xy_;
  std::vector<std::vector<float>> floats_;
  std::vector<std::vector<std::uint8_t>> bytes_;
};

/// Writes `FOLDER/meta.json`.
tl::expected<void, std::string> write_meta(const std::string& folder, const OfflineMapper& mapper,
                                           const MappedSweep& sweep);

/// Writes `FOLDER/voxels.npy`: every observed voxel of the fused map in z, y, x order.
tl::expected<void, std::string> write_voxels(const std::string& folder, MapFuser& fuser);

}  // namespace gvom::tools
