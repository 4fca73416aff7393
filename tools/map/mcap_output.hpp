// gvom-map's maps as one MCAP file.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/common/map_file.hpp"
#include "tools/map/offline.hpp"

namespace gvom::tools {

class McapOutput {
 public:
  /// Errors name the file, or the key that is wrong.
  static tl::expected<McapOutput, std::string> create(const std::string& path,
                                                      const services::VehicleConfig& config);

  /// Layers, which are of now, voxels and the vehicle's pose.
  tl::expected<void, std::string> write(const LayerArrays& layers, MapFuser& fuser);

  tl::expected<void, std::string> close() { return file_.close(); }

 private:
  explicit McapOutput(MapFile file) : file_(std::move(file)) {}

  MapFile file_;
  BrickMapStorage voxels_;
};

}  // namespace gvom::tools
