#include "services/common/config_table.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

namespace gvom::services {

namespace {

const std::string kLidars = "lidars";
const std::string kLidarsDot = kLidars + ".";

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

template <typename Config>
std::optional<Target> find_row(const std::vector<Row<Config>>& rows, const std::string& key, Config& config) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return key == r.info.key; });
  if (row == rows.end()) return std::nullopt;
  return Target{&row->info, row->field(config)};
}

template <typename Config>
bool is_prefix(const std::vector<Row<Config>>& rows, const std::string& prefix) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const auto& row) { return starts_with(row.info.key, prefix); });
}

/// Insertions, deletions and replacements that make `b` of `a` (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

template <typename Config>
void add_keys(const std::vector<Row<Config>>& rows, const std::string& prefix, std::set<std::string>& keys) {
  for (const auto& row : rows) {
    const std::string key = row.info.key;
    keys.insert(prefix + key);
    const std::size_t dot = key.rfind('.');
    if (dot != std::string::npos) keys.insert(prefix + key.substr(0, dot));
  }
}

const std::set<std::string>& vehicle_keys() {
  static const std::set<std::string> kKeys = [] {
    std::set<std::string> keys = {kLidars};
    add_keys(vehicle_rows(), "", keys);
    return keys;
  }();
  return kKeys;
}

std::size_t difference(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

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

std::optional<LidarKey> split_lidar_key(const std::string& key) {
  if (!starts_with(key, kLidarsDot)) return std::nullopt;
  const std::string after = key.substr(kLidarsDot.size());
  const std::size_t dot = after.find('.');
  if (dot == std::string::npos) return LidarKey{after, ""};
  return LidarKey{after.substr(0, dot), after.substr(dot + 1)};
}

std::optional<Target> find_target(VehicleConfig& config, const std::string& key) {
  const auto lidar_key = split_lidar_key(key);
  if (!lidar_key) return find_row(vehicle_rows(), key, config);
  LidarConfig* lidar = lidar_named(config, lidar_key->name);
  return lidar != nullptr ? find_row(lidar_rows(), lidar_key->rest, *lidar) : std::nullopt;
}

bool is_section(const std::string& key) {
  if (key.empty() || key == kLidars) return true;
  const auto lidar_key = split_lidar_key(key);
  if (!lidar_key) return is_prefix(vehicle_rows(), key + ".");
  return lidar_key->rest.empty() || is_prefix(lidar_rows(), lidar_key->rest + ".");
}

std::string nearest_key(const std::string& key) {
  constexpr std::size_t kLongest = 128;  // farther than that from any key, and slow to compare
  if (key.size() > kLongest) return "";
  std::set<std::string> lidar_keys;
  if (const auto lidar_key = split_lidar_key(key))
    add_keys(lidar_rows(), kLidarsDot + lidar_key->name + ".", lidar_keys);
  const std::size_t leaf_length = key.size() - (key.rfind('.') + 1);  // npos + 1 is 0
  std::size_t too_far = std::max<std::size_t>(2, leaf_length / 3) + 1;
  std::string nearest;
  const auto look_through = [&](const std::set<std::string>& candidates) {
    for (const std::string& candidate : candidates) {
      if (difference(key.size(), candidate.size()) >= too_far) continue;
      const std::size_t distance = edit_distance(key, candidate);
      if (distance >= too_far) continue;
      too_far = distance;
      nearest = candidate;
    }
  };
  look_through(vehicle_keys());
  look_through(lidar_keys);
  return nearest;
}

LidarConfig* lidar_named(VehicleConfig& config, const std::string& name) {
  const auto found = std::find_if(config.lidars.begin(), config.lidars.end(),
                                  [&](const LidarConfig& lidar) { return lidar.name == name; });
  return found != config.lidars.end() ? &*found : nullptr;
}

std::optional<Conflict> find_conflict(const VehicleConfig& config) {
  if (auto conflict = check_body(config.mapper.vehicle.body)) return conflict;
  if (auto conflict = check_layers(config.mapper.layers)) return conflict;
  if (auto conflict = check_cost(config.mapper.cost)) return conflict;
  return check_lidars(config.lidars);
}

}  // namespace gvom::services
