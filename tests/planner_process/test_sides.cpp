// Which lidars a vehicle needs to drive ahead, and back.
#include <catch2/catch.hpp>

#include <cstring>

#include "services/planner/process/sides.hpp"

using namespace gvom;
using planner::is_blind;
using planner::sides_of;

namespace {

services::LidarConfig lidar(const char* name, double yaw_rad) {
  services::LidarConfig config;
  config.name = name;
  config.extrinsic.yaw_rad = yaw_rad;
  return config;
}

ipc::Layers layers_of(const std::vector<std::pair<const char*, bool>>& lidars) {
  ipc::Layers layers{};
  for (const auto& [name, missing] : lidars) {
    ipc::LidarStatus& status = layers.lidars[layers.lidar_count++];
    std::strcpy(status.name, name);
    status.missing = missing ? 1 : 0;
  }
  return layers;
}

}  // namespace

TEST_CASE("a lidar serves the side that it faces; where none does, all serve") {
  const auto two = sides_of({lidar("front", 0), lidar("rear", 3.05)});
  CHECK(two.ahead == std::vector<std::string>{"front"});
  CHECK(two.behind == std::vector<std::string>{"rear"});
  const auto one = sides_of({lidar("top", 0.3)});
  CHECK(one.ahead == std::vector<std::string>{"top"});
  CHECK(one.behind == one.ahead);
}

TEST_CASE("a side is blind if one of its lidars is missing, or not there at all") {
  const auto layers = layers_of({{"front", false}, {"rear", true}});
  CHECK_FALSE(is_blind(layers, {"front"}));
  CHECK(is_blind(layers, {"rear"}));
  CHECK(is_blind(layers, {"front", "rear"}));
  CHECK(is_blind(layers, {"left"}));
  CHECK(is_blind(layers_of({}), {"front"}));
}
