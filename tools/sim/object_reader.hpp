// One object of objects.json, in full or in the short forms that a surveyor writes.
#pragma once

#include <string>

#include "tools/sim/json_keys.hpp"
#include "tools/sim/terrain.hpp"

namespace gvom::sim {

/// `where` is what a complaint begins with. Short forms stand on `terrain`.
Object read_object(const nlohmann::json& json, const std::string& where, const Terrain& terrain,
                   Complaint& complaint);

}  // namespace gvom::sim
