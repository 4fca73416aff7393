#include "services/common/config_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "services/common/config_table.hpp"
#include "services/common/yaml_documents.hpp"

namespace gvom::services {

namespace {

using Result = tl::expected<void, ConfigError>;

tl::unexpected<ConfigError> failure(std::string where, std::string key, std::string message) {
  return tl::make_unexpected(ConfigError{std::move(where), std::move(key), std::move(message)});
}

/// Where a value stands: a line of the file, or one --set.
struct Place {
  std::string text;
  bool has_lines;

  [[nodiscard]] std::string at(const YAML::Mark& mark) const {
    return has_lines && !mark.is_null() ? text + ":" + std::to_string(mark.line + 1) : text;
  }
};

std::string lidar_names(const VehicleConfig& config) {
  std::string names;
  for (const LidarConfig& lidar : config.lidars) names += (names.empty() ? "" : ", ") + lidar.name;
  return names;
}

class Loader {
 public:
  Result apply_file(const std::string& path);
  Result apply_set(const std::string& argument);
  tl::expected<VehicleConfig, ConfigError> finish();

 private:
  Result apply(const std::string& key, const YAML::Node& node, const Place& place, const std::string& where);
  Result apply_section(const std::string& section, const YAML::Node& node, const Place& place);
  Result add_lidar(const std::string& name, const std::string& where);
  Result check_required();
  [[nodiscard]] Result unknown(const std::string& key, const std::string& where) const;
  [[nodiscard]] std::string place_of(const std::string& key, const std::string& otherwise) const;

  VehicleConfig config_;
  std::map<std::string, std::string> places_;  // of every key that was given, its last place
};

Result Loader::apply_file(const std::string& path) {
  config_.path = path;
  errno = 0;
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf())) {
    return failure(path, "", errno != 0 ? std::strerror(errno) : "is empty");
  }
  try {
    const int documents = count_yaml_documents(text.str());
    if (documents != 1) {
      return failure(path, "",
                     std::string("expected one YAML document, found ") + (documents == 0 ? "none" : "more"));
    }
    return apply_section("", YAML::Load(text.str()), Place{path, true});
  } catch (const YAML::Exception& error) {
    return failure(Place{path, true}.at(error.mark), "", "not YAML: " + error.msg);
  }
}

Result Loader::apply_set(const std::string& argument) {
  const std::string where = "--set " + argument;
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) return failure(where, "", "expected KEY=VALUE");
  const std::string key = argument.substr(0, equals);
  if (key.empty()) return failure(where, "", "expected KEY=VALUE");
  const auto lidar_key = split_lidar_key(key);
  if (lidar_key && lidar_named(config_, lidar_key->name) == nullptr) {
    return failure(
        where, key,
        "no lidar '" + lidar_key->name + "' in " + config_.path + ", which has: " + lidar_names(config_));
  }
  try {
    const std::string value = argument.substr(equals + 1);
    return apply(key, value.empty() ? YAML::Node("") : YAML::Load(value), Place{where, false}, where);
  } catch (const YAML::Exception& error) {
    return failure(where, key, "not YAML: " + error.msg);
  }
}

Result Loader::apply(const std::string& key, const YAML::Node& node, const Place& place,
                     const std::string& where) {
  if (const auto target = find_target(config_, key)) {
    places_[key] = where;
    const auto assigned = assign(*target->row, node, target->field);
    return assigned ? Result{} : failure(where, key, assigned.error());
  }
  if (!is_section(key)) return unknown(key, where);
  if (!node.IsMap()) return failure(where, key, "expected a mapping of keys");
  places_[key] = where;
  return apply_section(key, node, place);
}

Result Loader::apply_section(const std::string& section, const YAML::Node& node, const Place& place) {
  if (!node.IsMap()) return failure(place.at(node.Mark()), section, "expected a mapping of keys");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string where = place.at(entry.first.Mark());
    if (!entry.first.IsScalar()) return failure(where, section, "expected keys that are plain text");
    const std::string& name = entry.first.Scalar();
    const std::string key = section.empty() ? name : section + "." + name;
    if (!seen.insert(name).second) return failure(where, key, "repeated: expected once");
    if (section == "lidars") {
      const Result added = add_lidar(name, where);
      if (!added) return added;
    } else if (name.find('.') != std::string::npos) {
      return unknown(key, where);
    }
    const Result applied = apply(key, entry.second, place, where);
    if (!applied) return applied;
  }
  return {};
}

Result Loader::add_lidar(const std::string& name, const std::string& where) {
  if (!is_identifier(name)) {
    return failure(where, "lidars." + name, "expected a lidar's name of [a-z0-9_], 1 to 31 characters");
  }
  if (lidar_named(config_, name) == nullptr) config_.lidars.emplace_back().name = name;
  return {};
}

Result Loader::unknown(const std::string& key, const std::string& where) const {
  const std::string nearest = nearest_key(key);
  return failure(where, key, nearest.empty() ? "unknown key" : "unknown key, did you mean " + nearest + "?");
}

std::string Loader::place_of(const std::string& key, const std::string& otherwise) const {
  const auto place = places_.find(key);
  return place != places_.end() ? place->second : otherwise;
}

Result Loader::check_required() {
  for (const VehicleRow& row : vehicle_rows()) {
    if (row.info.required && places_.count(row.info.key) == 0) {
      return failure(config_.path, row.info.key,
                     "missing: expected " + expected_text(row.info, row.field(config_)));
    }
  }
  for (LidarConfig& lidar : config_.lidars) {
    const std::string prefix = "lidars." + lidar.name;
    for (const LidarRow& row : lidar_rows()) {
      const std::string key = prefix + "." + row.info.key;
      if (row.info.required && places_.count(key) == 0) {
        return failure(place_of(prefix, config_.path), key,
                       "missing: expected " + expected_text(row.info, row.field(lidar)));
      }
    }
  }
  return {};
}

tl::expected<VehicleConfig, ConfigError> Loader::finish() {
  const auto by_name = [](const LidarConfig& a, const LidarConfig& b) { return a.name < b.name; };
  std::sort(config_.lidars.begin(), config_.lidars.end(), by_name);
  const Result complete = check_required();
  if (!complete) return tl::make_unexpected(complete.error());
  if (const auto conflict = find_conflict(config_)) {
    const std::string where = place_of(conflict->key, place_of(conflict->other_key, config_.path));
    return failure(where, conflict->key, conflict->message);
  }
  for (LidarConfig& lidar : config_.lidars) lidar.geometry.T_base_sensor = to_isometry(lidar.extrinsic);
  return config_;
}

}  // namespace

std::string ConfigError::text() const {
  return where + ": " + (key.empty() ? "" : key + ": ") + message;
}

tl::expected<VehicleConfig, ConfigError> load_vehicle_config(const std::string& path,
                                                             const std::vector<std::string>& sets) {
  Loader loader;
  Result result = loader.apply_file(path);
  for (std::size_t i = 0; result && i < sets.size(); ++i) result = loader.apply_set(sets[i]);
  if (!result) return tl::make_unexpected(result.error());
  return loader.finish();
}

tl::expected<const LidarConfig*, ConfigError> find_lidar(const VehicleConfig& config, std::string_view name) {
  for (const LidarConfig& lidar : config.lidars) {
    if (lidar.name == name) return &lidar;
  }
  return failure(config.path, "lidars",
                 "no lidar '" + std::string(name) + "', there is: " + lidar_names(config));
}

Eigen::Isometry3d to_isometry(const Extrinsic& extrinsic) {
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(extrinsic.yaw_rad, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(extrinsic.pitch_rad, Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(extrinsic.roll_rad, Eigen::Vector3d::UnitX());
  Eigen::Isometry3d T_base_sensor = Eigen::Isometry3d::Identity();
  T_base_sensor.linear() = rotation.toRotationMatrix();
  T_base_sensor.translation() = Eigen::Vector3d(extrinsic.x_m, extrinsic.y_m, extrinsic.z_m);
  return T_base_sensor;
}

}  // namespace gvom::services
