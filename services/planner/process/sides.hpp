// Which lidars look ahead and which behind.
#pragma once

#include <vector>

#include "ipc/messages.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::planner {

/// The lidars that a side is seen by, sorted names: those that face it; if none does, all.
struct Sides {
  std::vector<std::string> ahead;
  std::vector<std::string> behind;
};
Sides sides_of(const std::vector<services::LidarConfig>& lidars);

/// Whether layers name one of them as missing, or do not know it.
bool is_blind(const ipc::Layers& layers, const std::vector<std::string>& side);

}  // namespace gvom::planner
