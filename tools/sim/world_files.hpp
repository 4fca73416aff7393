// A world as files that a person can write: ground.npy, surface.npy and objects.json.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// Reads `directory`. Errors name the file, and in objects.json the object's number and the key.
tl::expected<WorldData, std::string> read_world(const std::string& directory);

/// Writes what `read_world` reads back as the same world, to the bit, into `directory`, which is made if it
/// is not there.
tl::expected<void, std::string> save_world(const WorldData& world, const std::string& directory);

}  // namespace gvom::sim
