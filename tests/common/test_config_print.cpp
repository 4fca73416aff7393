// --print-config says everything and loads again to the same; the shipped files and the reference hold.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "services/common/config_file.hpp"
#include "services/common/config_table.hpp"
#include "services/common/vehicle_config.hpp"
#include "tests/common/temporary_file.hpp"

namespace {

using namespace gvom;
using services::Field;
using services::RowInfo;
using services::Rule;

std::string printed(const services::VehicleConfig& config) {
  std::ostringstream out;
  services::print_config(config, out);
  return out.str();
}

/// Sets fields to random values that their rows allow.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  void fill(const RowInfo& row, const Field& field) {
    if (auto* const* number = std::get_if<double*>(&field)) **number = uniform(row.min, row.max);
    if (auto* const* whole = std::get_if<int*>(&field)) **whole = integer(row);
    if (auto* const* text = std::get_if<std::string*>(&field)) **text = this->text(row.rule);
    if (auto* const* backend = std::get_if<Backend*>(&field)) {
      const auto& words = services::kBackendWords;
      **backend = words[static_cast<std::size_t>(uniform(0, std::size(words)))].second;
    }
    if (auto* const* steering = std::get_if<planner::Steering*>(&field)) {
      const auto& words = services::kSteeringWords;
      **steering = words[static_cast<std::size_t>(uniform(0, std::size(words)))].second;
    }
    if (auto* const* clock = std::get_if<services::LidarClock*>(&field)) {
      const auto& words = services::kClockWords;
      **clock = words[static_cast<std::size_t>(uniform(0, std::size(words)))].second;
    }
  }

  double uniform(double min, double max) { return std::uniform_real_distribution<double>(min, max)(engine_); }

  int integer(const RowInfo& row) {
    const int value =
        std::uniform_int_distribution<int>(static_cast<int>(row.min), static_cast<int>(row.max))(engine_);
    if (row.rule == Rule::multiple_of_8) return value / 8 * 8;
    return row.rule == Rule::odd ? value | 1 : value;
  }

  std::string text(Rule rule) {
    const std::string characters =
        rule == Rule::identifier ? "az09_" : "aZ 0'\"#:{}[],&*!|>%@`\\?=-~\xc3\xa4";
    std::string result;
    for (int length = 1 + static_cast<int>(uniform(0, 30)); length > 0; --length) {
      result += characters[static_cast<std::size_t>(uniform(0, static_cast<double>(characters.size())))];
    }
    return result;
  }

 private:
  std::mt19937 engine_;
};

services::VehicleConfig random_config(unsigned seed) {
  Random random(seed);
  services::VehicleConfig config;
  for (const auto& row : services::vehicle_rows()) random.fill(row.info, row.field(config));
  config.mapper.layers.max_obstacle_height_m += config.mapper.layers.min_obstacle_height_m / 5;
  if (config.mapper.layers.max_obstacle_height_m <= config.mapper.layers.min_obstacle_height_m) {
    std::swap(config.mapper.layers.max_obstacle_height_m, config.mapper.layers.min_obstacle_height_m);
  }
  config.mapper.layers.max_obstacle_height_m = std::min(config.mapper.layers.max_obstacle_height_m, 50.0);
  if (seed % 2 == 0) {
    const Eigen::Vector3d corner(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    config.mapper.vehicle.body = Box{-corner, corner / 3};
  }
  for (const char* name : {"123", "front", "null"}) {
    services::LidarConfig& lidar = config.lidars.emplace_back();
    for (const auto& row : services::lidar_rows()) random.fill(row.info, row.field(lidar));
    lidar.name = name;
    lidar.geometry.max_range_m = lidar.geometry.min_range_m + 0.1;
    if (lidar.geometry.max_range_m > 1000) lidar.geometry.min_range_m = 1;
    lidar.geometry.max_range_m = std::min(lidar.geometry.max_range_m, 1000.0);
    lidar.geometry.T_base_sensor = services::to_isometry(lidar.extrinsic);
  }
  return config;
}

}  // namespace

TEST_CASE("any configuration that is printed loads again to the same, to the bit") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const services::VehicleConfig config = random_config(seed);
    const std::string yaml = printed(config);
    const test::TemporaryFile file(yaml);
    const auto again = services::load_vehicle_config(file.path());
    INFO("seed " << seed << "\n" << yaml << (again ? "" : again.error().text()));
    REQUIRE(again);
    REQUIRE(printed(*again) == yaml);  // numbers print in their shortest exact form: same text, same bits
    REQUIRE(again->lidars.size() == config.lidars.size());
    for (std::size_t i = 0; i < config.lidars.size(); ++i) {
      const auto& T_a = again->lidars[i].geometry.T_base_sensor.matrix();
      REQUIRE(T_a == config.lidars[i].geometry.T_base_sensor.matrix());
      REQUIRE(again->lidars[i].source == config.lidars[i].source);
      REQUIRE(again->lidars[i].backend == config.lidars[i].backend);
    }
    REQUIRE(again->odometry.source == config.odometry.source);
    REQUIRE(again->fusion.backend == config.fusion.backend);
    REQUIRE(again->mapper.map.resolution_xy_m == config.mapper.map.resolution_xy_m);
    REQUIRE(again->mapper.vehicle.body.has_value() == config.mapper.vehicle.body.has_value());
  }
}

TEST_CASE("every default lies within its own bounds") {
  const std::string minimal =
      "name: v\nlidars: {a: {T_base_sensor: {x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}}}\n";
  const test::TemporaryFile file(minimal);
  const auto config = services::load_vehicle_config(file.path());
  REQUIRE(config);
  const test::TemporaryFile whole(printed(*config));
  const auto again = services::load_vehicle_config(whole.path());
  INFO((again ? "" : again.error().text()));
  CHECK(again);
}

TEST_CASE("no key stands twice in the table and every key has its field for itself") {
  services::VehicleConfig config;
  std::set<std::string> keys;
  for (const auto& row : services::vehicle_rows()) CHECK(keys.insert(row.info.key).second);
  for (const auto& row : services::lidar_rows()) CHECK(keys.insert(row.info.key).second);
  std::set<const void*> fields;
  for (const auto& row : services::vehicle_rows()) {
    const Field field = row.field(config);
    if (auto* const* number = std::get_if<double*>(&field)) CHECK(fields.insert(*number).second);
    if (auto* const* whole = std::get_if<int*>(&field)) CHECK(fields.insert(*whole).second);
    if (auto* const* backend = std::get_if<Backend*>(&field)) CHECK(fields.insert(*backend).second);
  }
}

TEST_CASE("the hash tells configurations apart, however they were written, and nothing else") {
  const std::string file = GVOM_SOURCE_DIR "/config/vehicles/two_lidars.yaml";
  const auto config = services::load_vehicle_config(file).value();
  std::ostringstream text;
  services::print_config(config, text);
  const test::TemporaryFile printed(text.str());
  const auto hash_with = [&](const std::string& set) {
    return config_hash(services::load_vehicle_config(file, {set}).value());
  };
  CHECK(config_hash(services::load_vehicle_config(printed.path()).value()) == config_hash(config));
  CHECK(hash_with("map.size_xy=" + std::to_string(config.mapper.map.size_xy)) == config_hash(config));
  CHECK(hash_with("map.resolution_z_m=0.123") != config_hash(config));
  CHECK(hash_with("lidars.front.T_base_sensor.z=0.123") != config_hash(config));
}

TEST_CASE("the shipped vehicle files load") {
  for (const std::string name :
       {"kitti", "moose", "ouster_os1_128", "ranger", "two_lidars", "warthog", "warthog_two"}) {
    const auto config = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/" + name + ".yaml");
    INFO((config ? "" : config.error().text()));
    REQUIRE(config);
    CHECK(config->name == name);
  }
}

// To write the table anew after a change: GVOM_UPDATE_REFERENCE=1 test_common_config_print
TEST_CASE("config/README.md ends with the reference as it is generated") {
  const std::string path = GVOM_SOURCE_DIR "/config/README.md";
  std::stringstream readme;
  readme << std::ifstream(path).rdbuf();
  std::ostringstream reference;
  services::print_config_reference(reference);
  const std::string text = readme.str();
  const std::string before = text.substr(0, text.find("| key |"));
  if (std::getenv("GVOM_UPDATE_REFERENCE") != nullptr) std::ofstream(path) << before << reference.str();
  CHECK((text == before + reference.str()));
}
