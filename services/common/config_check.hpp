// What no single key can tell: keys that contradict each other.
#pragma once

#include <optional>
#include <string>

#include "services/common/vehicle_config.hpp"

namespace gvom::services {

struct Conflict {
  std::string key;
  std::string other_key;
  std::string message;
};

std::optional<Conflict> find_conflict(const VehicleConfig& config);

}  // namespace gvom::services
