#include "tools/sim/world_files.hpp"

namespace gvom::sim {

tl::expected<WorldData, std::string> read_world(const std::string& directory) {
  return tl::unexpected(directory + ": cannot be read yet");
}

tl::expected<void, std::string> save_world(const WorldData&, const std::string& directory) {
  return tl::unexpected(directory + ": cannot be written yet");
}

}  // namespace gvom::sim
