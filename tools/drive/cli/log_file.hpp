// What the planner saw and meant on a drive, as a file of lines.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "tools/drive/cli/session.hpp"

namespace gvom::driving {

/// FOLDER/WORLD-SEED.csv, a line for each turn; nothing where the folder is empty.
class DriveFile {
 public:
  DriveFile(const std::string& folder, const std::string& world, std::uint64_t seed);

  /// Writes. Valid while this lives.
  [[nodiscard]] Onlooker onlooker();

 private:
  void write(const Seen& seen, const planner::Plan& plan);

  std::ofstream file_;
};

}  // namespace gvom::driving
