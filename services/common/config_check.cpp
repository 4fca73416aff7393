#include "services/common/config_check.hpp"

#include "ipc/messages.hpp"

namespace gvom::services {

namespace {

std::optional<Conflict> check_body(const std::optional<Box>& body) {
  if (!body) return std::nullopt;
  const std::string min_key = "vehicle.body_min_m";
  const std::string max_key = "vehicle.body_max_m";
  if (body->min_m.hasNaN()) return Conflict{min_key, max_key, "missing: body_max_m is there, both or none"};
  if (body->max_m.hasNaN()) return Conflict{max_key, min_key, "missing: body_min_m is there, both or none"};
  if ((body->min_m.array() < body->max_m.array()).all()) return std::nullopt;
  return Conflict{max_key, min_key, "expected more than body_min_m on each axis"};
}

std::optional<Conflict> check_layers(const LayersConfig& layers) {
  if (layers.max_obstacle_height_m > layers.min_obstacle_height_m) return std::nullopt;
  return Conflict{"layers.max_obstacle_height_m", "layers.min_obstacle_height_m",
                  "expected more than min_obstacle_height_m"};
}

std::optional<Conflict> check_cost(const CostConfig& cost) {
  if (cost.soft_weight > 0 || cost.slope_weight > 0 || cost.roughness_weight > 0) return std::nullopt;
  return Conflict{"cost.soft_weight", "cost.slope_weight", "expected one of the three weights above 0"};
}

std::optional<Conflict> check_lidars(const std::vector<LidarConfig>& lidars) {
  const std::string most = std::to_string(kMaxLidars);
  if (lidars.empty()) return Conflict{"lidars", "", "missing: expected 1 to " + most + " lidars"};
  if (lidars.size() > kMaxLidars) {
    return Conflict{"lidars", "",
                    "expected 1 to " + most + " lidars, found " + std::to_string(lidars.size())};
  }
  for (const LidarConfig& lidar : lidars) {
    const std::string prefix = "lidars." + lidar.name;
    if (lidar.geometry.min_range_m >= lidar.geometry.max_range_m) {
      return Conflict{prefix + ".max_range_m", prefix + ".min_range_m", "expected more than min_range_m"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Conflict> find_conflict(const VehicleConfig& config) {
  if (auto conflict = check_body(config.mapper.vehicle.body)) return conflict;
  if (auto conflict = check_layers(config.mapper.layers)) return conflict;
  if (auto conflict = check_cost(config.mapper.cost)) return conflict;
  return check_lidars(config.lidars);
}

}  // namespace gvom::services
