#include "tools/sim/json_keys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace gvom::sim {
namespace {

using nlohmann::json;

constexpr double kFarthest = 1e5;  // metres, or seconds

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

JsonKeys::JsonKeys(const json& json, std::string where, Complaint& complaint)
    : json_(json), where_(std::move(where)), complaint_(complaint) {
  if (!json_.is_object()) complain("expected an object in braces");
}

void JsonKeys::allow_only(std::initializer_list<const char*> keys) const {
  if (!json_.is_object()) return;
  for (const auto& entry : json_.items()) {
    const bool known =
        std::any_of(keys.begin(), keys.end(), [&](const char* key) { return entry.key() == key; });
    if (!known) complain("unknown key \"" + entry.key() + "\"");
  }
}

const json* JsonKeys::find(const char* key) const {
  if (has(key)) return &json_.at(key);
  complain(std::string("\"") + key + "\" is missing");
  return nullptr;
}

double JsonKeys::number(const char* key, const Bounds& bounds) const {
  const json* value = find(key);
  if (value == nullptr) return 0.0;
  if (value->is_number() && value->get<double>() >= bounds.low && value->get<double>() <= bounds.high)
    return value->get<double>();
  complain(std::string("\"") + key + "\": expected a number of " + short_text(bounds.low) + " .. " +
           short_text(bounds.high));
  return 0.0;
}

double JsonKeys::number_or(const char* key, const Bounds& bounds, double otherwise) const {
  return has(key) ? number(key, bounds) : otherwise;
}

std::string JsonKeys::word(const char* key) const {
  const json* value = find(key);
  if (value == nullptr) return {};
  if (value->is_string()) return value->get<std::string>();
  complain(std::string("\"") + key + "\": expected a word in quotes");
  return {};
}

Eigen::VectorXd JsonKeys::numbers(const json& json, const char* key, int size) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
  bool good = json.is_array() && json.size() == static_cast<std::size_t>(size);
  for (int i = 0; good && i < size; ++i) {
    good = json[i].is_number() && std::abs(json[i].get<double>()) <= kFarthest;
    if (good) values[i] = json[i].get<double>();
  }
  if (good) return values;
  complain(std::string("\"") + key + "\": expected lists of " + std::to_string(size) + " numbers within " +
           short_text(kFarthest));
  return Eigen::VectorXd::Zero(size);
}

Eigen::VectorXd JsonKeys::point(const char* key, int size) const {
  const json* value = find(key);
  return value == nullptr ? Eigen::VectorXd::Zero(size).eval() : numbers(*value, key, size);
}

Eigen::Vector3d JsonKeys::point_or(const char* key, const Eigen::Vector3d& otherwise) const {
  return has(key) ? Eigen::Vector3d(point(key, 3)) : otherwise;
}

const json& JsonKeys::list(const char* key) const {
  static const json none = json::array();
  const json* value = find(key);
  if (value == nullptr) return none;
  if (value->is_array()) return *value;
  complain(std::string("\"") + key + "\": expected a list in brackets");
  return none;
}

}  // namespace gvom::sim
