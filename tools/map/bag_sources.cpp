#include "tools/map/bag_sources.hpp"

namespace gvom::tools {

bool fill_bag(std::string& source, const std::string& path) {
  const std::string open = "bag:?";
  if (source.compare(0, open.size(), open) != 0) return false;
  source.insert(open.size() - 1, path);
  return true;
}

int fill_bag(services::VehicleConfig& config, const std::string& path) {
  int filled = fill_bag(config.odometry.source, path) ? 1 : 0;
  for (services::LidarConfig& lidar : config.lidars) filled += fill_bag(lidar.source, path) ? 1 : 0;
  return filled;
}

}  // namespace gvom::tools
