#include "services/planner/process/sides.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace gvom::planner {

Sides sides_of(const std::vector<services::LidarConfig>& lidars) {
  Sides sides;
  std::vector<std::string> all;
  for (const services::LidarConfig& lidar : lidars) {
    all.push_back(lidar.name);
    (std::cos(lidar.extrinsic.yaw_rad) >= 0 ? sides.ahead : sides.behind).push_back(lidar.name);
  }
  if (sides.ahead.empty()) sides.ahead = all;
  if (sides.behind.empty()) sides.behind = all;
  return sides;
}

bool is_blind(const ipc::Layers& layers, const std::vector<std::string>& side) {
  const auto end = layers.lidars + layers.lidar_count;
  return std::any_of(side.begin(), side.end(), [&](const std::string& name) {
    const auto found = std::find_if(layers.lidars, end, [&](const ipc::LidarStatus& lidar) {
      return std::string_view(lidar.name, strnlen(lidar.name, sizeof lidar.name)) == name;
    });
    return found == end || found->missing != 0;
  });
}

}  // namespace gvom::planner
