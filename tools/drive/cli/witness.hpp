// What is kept of a drive: a line for each plan, and a film of it.
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/log_file.hpp"
#include "tools/drive/pictures/film.hpp"

namespace gvom::driving {

/// Of which drives a picture is left.
enum class Strips : std::uint8_t { none, failed, all };
/// "none", "failed", "all"; the error lists them.
tl::expected<Strips, std::string> find_strips(const std::string& name);

class Witness {
 public:
  /// FOLDER/WORLD-SEED.csv and .png; nothing where the folder is empty.
  Witness(const std::string& folder, const CourseWorld& world, std::uint64_t seed, Strips strips);

  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  /// Valid while this lives.
  [[nodiscard]] Onlooker onlooker();
  /// Leaves the picture, if one is wanted of that result. `words`: of it, in a line. Errors name the file.
  tl::expected<void, std::string> finish(const planner::VehicleLimits& vehicle, Outcome outcome,
                                         const std::string& words) const;

 private:
  DriveFile file_;
  Onlooker file_looks_;
  const CourseWorld& world_;
  std::string picture_;
  Strips strips_;
  Film film_;
};

}  // namespace gvom::driving
