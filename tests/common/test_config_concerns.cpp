// Which key of the vehicle's file concerns whom.
#include <catch2/catch.hpp>

#include <set>
#include <string>
#include <vector>

#include "services/common/config_concerns.hpp"
#include "services/common/config_file.hpp"
#include "services/common/config_table.hpp"

using namespace gvom;
using Names = std::set<std::string>;

namespace {

const std::vector<std::string> kProcesses = {"gvom-roudi",        "gvom-fusion",      "gvom-odometry",
                                             "gvom-ingest-front", "gvom-ingest-rear", "gvom-planner",
                                             "gvom-bridge",       "gvom-snapshot"};

services::VehicleConfig vehicle(const std::vector<std::string>& sets = {}) {
  const auto config = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/two_lidars.yaml", sets);
  if (!config) throw std::runtime_error(config.error().text());
  return *config;
}

/// Whose hash differs.
Names changed_by(const services::VehicleConfig& changed) {
  Names names;
  for (const std::string& process : kProcesses)
    if (services::config_hash(changed, process) != services::config_hash(vehicle(), process))
      names.insert(process);
  return names;
}

Names changed_by(const std::string& set) {
  return changed_by(vehicle({set}));
}

}  // namespace

TEST_CASE("a change concerns those who use the key, and nobody else") {
  CHECK(changed_by("layers.min_hits=7") == Names{"gvom-fusion"});
  CHECK(changed_by("fusion.missing_after_s=0.7") == Names{"gvom-fusion"});
  CHECK(changed_by("lidars.front.T_base_sensor.z=0.123") == Names{"gvom-ingest-front"});
  CHECK(changed_by("lidars.rear.source='ouster-udp:7777?meta=a.json'") == Names{"gvom-ingest-rear"});
  CHECK(changed_by("odometry.max_gap_s=0.7") == Names{"gvom-ingest-front", "gvom-ingest-rear"});
  CHECK(changed_by("odometry.source='tum:other.tum'") == Names{"gvom-odometry"});
  CHECK(changed_by("map.resolution_z_m=0.123") ==
        Names{"gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"});
  CHECK(changed_by("planner.speed_mps=3") == Names{"gvom-planner"});
  CHECK(changed_by("vehicle.width_m=1.9") == Names{"gvom-planner"});
  CHECK(changed_by("vehicle.body_min_m=[-1, -1, -1]") == Names{"gvom-ingest-front", "gvom-ingest-rear"});
  CHECK(changed_by("vehicle.radius_m=1.9") == Names{"gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"});
  CHECK(changed_by("lidars.front.T_base_sensor.yaw=0.5") == Names{"gvom-ingest-front", "gvom-planner"});
  CHECK(changed_by("ipc.max_planners=7") == Names{"gvom-roudi"});
  CHECK(changed_by("bridge.rate_hz=3") == Names{"gvom-bridge"});
  CHECK(changed_by("name=other").empty());
}

TEST_CASE("another lidar concerns those who serve all of them") {
  services::VehicleConfig more = vehicle();
  more.lidars.push_back(more.lidars.back());
  more.lidars.back().name = "left";
  CHECK(changed_by(more) == Names{"gvom-roudi", "gvom-fusion", "gvom-odometry", "gvom-planner"});
}

TEST_CASE("each key concerns somebody, but the vehicle's name") {
  const auto concerns_somebody = [](const std::string& key) {
    for (const std::string& process : kProcesses)
      if (services::concerns(key, process)) return true;
    return false;
  };
  for (const auto& row : services::vehicle_rows())
    CHECK(concerns_somebody(row.info.key) == (std::string(row.info.key) != "name"));
  for (const auto& row : services::lidar_rows())
    CHECK(concerns_somebody(std::string("lidars.front.") + row.info.key));
}
