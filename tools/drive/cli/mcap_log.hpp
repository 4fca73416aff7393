// What the planner saw and meant on a drive, as a file that opens in Foxglove.
#pragma once

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/common/map_file.hpp"
#include "tools/drive/cli/session.hpp"

namespace gvom::driving {

class McapLog {
 public:
  /// Errors name the file, or the key that is wrong.
  static tl::expected<McapLog, std::string> create(const std::string& path,
                                                   const services::VehicleConfig& config);

  /// A turn: layers, pose, path and trajectory. After an error nothing more is written.
  void add(const Seen& seen, const planner::Plan& plan);
  /// The first error, if there was one.
  tl::expected<void, std::string> close();

 private:
  explicit McapLog(tools::MapFile file) : file_(std::move(file)) {}

  tools::MapFile file_;
  tl::expected<void, std::string> written_;
};

}  // namespace gvom::driving
