// What is kept of a drive: a line for each plan, a film of it, a file for Foxglove.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/log_file.hpp"
#include "tools/drive/cli/mcap_log.hpp"
#include "tools/drive/pictures/film.hpp"

namespace gvom::driving {

/// Of which drives a picture is left.
enum class Strips : std::uint8_t { none, failed, all };
/// "none", "failed", "all"; the error lists them.
tl::expected<Strips, std::string> find_strips(const std::string& name);

/// What is to be kept.
struct Keeping {
  std::string folder;  ///< FOLDER/WORLD-SEED.csv, .png and .mcap; empty: nothing.
  Strips strips = Strips::failed;
  bool mcap = false;
};

class Witness {
 public:
  Witness(const Keeping& keeping, const CourseWorld& world, std::uint64_t seed,
          const services::VehicleConfig& config);

  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  /// Valid while this lives.
  [[nodiscard]] Onlooker onlooker();
  /// Leaves the picture, if one is wanted of that result. `words`: of it, in a line. Errors name the file
  /// that could not be written.
  tl::expected<void, std::string> finish(Outcome outcome, const std::string& words);

 private:
  DriveFile file_;
  Onlooker file_looks_;
  const CourseWorld& world_;
  planner::VehicleLimits vehicle_;
  std::string picture_;
  Strips strips_;
  std::optional<tl::expected<McapLog, std::string>> mcap_;
  Film film_;
};

}  // namespace gvom::driving
