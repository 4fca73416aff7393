// Layers as files: a folder of .npy arrays and a meta.json, the form that gvom-map writes too.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/snapshot/picture.hpp"

namespace gvom::snapshot {

/// Layers read from a folder. `picture` points into the vectors: moving is fine, copying is not.
struct StoredLayers {
  StoredLayers() = default;
  StoredLayers(StoredLayers&&) = default;
  StoredLayers& operator=(StoredLayers&&) = default;

  LayersPicture picture;
  std::array<std::vector<float>, kFloatLayers> float_values;
  std::array<std::vector<std::uint8_t>, kLayers - kFloatLayers> byte_values;
};

/// Needs in meta.json `stamp_ns`, `origin` [x, y, z], `size` [n_xy, n_xy, n_z], `resolution_m` [xy, z]; takes
/// `vehicle`, `maps_in_window`, `base_position_m`, `base_orientation_xyzw` and `lidars` if they are there.
/// Errors name the file and the key.
tl::expected<StoredLayers, std::string> read_folder(const std::string& folder);

/// Makes the folder, writes all layers and then meta.json with all of the above. Errors name the file.
tl::expected<void, std::string> write_folder(const std::string& folder, const LayersPicture& picture);

}  // namespace gvom::snapshot
