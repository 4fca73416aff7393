// What the bridge makes of messages of the bus that say more than is true.
#include <catch2/catch.hpp>

#include "services/bridge/message_maker.hpp"
#include "services/common/ros/schemas.hpp"
#include "tests/bridge/schema_reader.hpp"

namespace {

using namespace gvom;
using bridge::TopicId;
using nlohmann::json;

json path_of(bridge::MessageMaker& maker, TopicId id, const ipc::Plan& plan) {
  return test::read_message(*ros::schema_of("nav_msgs/msg/Path"), *maker.path(id, 5, plan));
}

TEST_CASE("a plan that claims more points than it has room for becomes a path of those it has") {
  const auto plan = std::make_unique<ipc::Plan>();
  plan->path_count = ipc::Plan::kMaxPoints + 1;  // the next would be the trajectory's first
  plan->trajectory_count = UINT32_MAX;
  plan->path[ipc::Plan::kMaxPoints - 1].x_m = 7;
  plan->trajectory[0].x_m = 8;
  bridge::MessageMaker maker({});
  const json path = path_of(maker, TopicId::plan, *plan);
  REQUIRE(path["poses"].size() == ipc::Plan::kMaxPoints);
  CHECK(path["poses"].back()["pose"]["position"]["x"] == 7.0);
  const json trajectory = path_of(maker, TopicId::trajectory, *plan);
  REQUIRE(trajectory["poses"].size() == ipc::Plan::kMaxPoints);
  CHECK(trajectory["poses"].front()["pose"]["position"]["x"] == 8.0);
}

}  // namespace
