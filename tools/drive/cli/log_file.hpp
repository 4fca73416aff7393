// What the planner saw and meant on a drive, as a file of lines.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/session.hpp"

namespace gvom::driving {

/// FOLDER/WORLD-SEED.csv, a line for each turn; nothing where the folder is empty.
class DriveFile {
 public:
  DriveFile(const std::string& folder, const std::string& world, std::uint64_t seed);

  /// Writes; a line is in the file when it returns. Valid while this lives.
  [[nodiscard]] Onlooker onlooker();
  /// The error names the file if any line of it could not be written.
  tl::expected<void, std::string> close();

 private:
  void write(const Seen& seen, const planner::Plan& plan);

  std::string path_;  // empty: none
  std::ofstream file_;
};

}  // namespace gvom::driving
