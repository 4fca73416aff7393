// Clouds, poses and diagnostics against the ROS definitions, read by their schemas alone.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/brick_map_storage.hpp"
#include "ipc/text.hpp"
#include "services/common/ros/blob_pool.hpp"
#include "services/common/ros/cloud_messages.hpp"
#include "services/common/ros/diagnostics_message.hpp"
#include "services/common/ros/pose_messages.hpp"
#include "services/common/ros/schemas.hpp"
#include "tests/bridge/schema_reader.hpp"
#include "tests/bridge/small_layers.hpp"
#include "tests/support/ros_messages.hpp"

namespace {

using namespace gvom;
using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;

std::vector<float> floats_of(const json& cloud) {
  const auto data = cloud["data"].get<Bytes>();
  std::vector<float> floats(data.size() / 4);
  std::memcpy(floats.data(), data.data(), floats.size() * 4);
  return floats;
}

TEST_CASE("a cloud of columns has those with a height, at their centres") {
  test::SmallLayers layers(2);
  Bytes bytes;
  ros::write_columns_cloud(layers.view, {LayerId::slope, LayerId::flags}, "odom", bytes);
  const json cloud = test::read_message(*ros::schema_of("sensor_msgs/msg/PointCloud2"), bytes);
  CHECK(cloud["width"] == 2);
  CHECK(cloud["height"] == 1);
  CHECK(cloud["point_step"] == 20);
  CHECK(cloud["row_step"] == 40);
  CHECK(cloud["is_dense"] == 1);
  std::string names;
  for (const json& field : cloud["fields"]) {
    names += field["name"].get<std::string>() + "@" + std::to_string(field["offset"].get<int>()) + " ";
    CHECK(field["datatype"] == 7);
    CHECK(field["count"] == 1);
  }
  CHECK(names == "x@0 y@4 z@8 slope@12 flags@16 ");
  // Columns 0 and 3: (0, 0) and (1, 1).
  CHECK(floats_of(cloud) == std::vector<float>{-3.75F, 8.25F, 0, 400, 10, -3.25F, 8.75F, 3, 403, 13});
}

TEST_CASE("a cloud of voxels has those with hits, and their density") {
  BrickMapStorage storage;
  const BrickMapArrays arrays = storage.resize({2, 1, 2, 64});
  arrays.directory[0] = -1;
  arrays.directory[1] = 0;
  for (int i = 0; i < 512; ++i) arrays.lookup[i] = free_lookup(3);
  arrays.lookup[0] = 0;
  arrays.lookup[(1 * 8 + 2) * 8 + 7] = 1;
  arrays.records[0] = {3, 1, 0};
  arrays.records[1] = {2, 0, 0};
  Grid grid;
  grid.origin = {8, -16, 0};
  grid.size = {8, 8, 16};
  grid.resolution_m = {0.5, 0.5, 0.25};
  Bytes bytes;
  ros::write_voxels_cloud(storage.view(grid, 7, {}), "odom", bytes);
  const json cloud = test::read_message(*ros::schema_of("sensor_msgs/msg/PointCloud2"), bytes);
  CHECK(cloud["header"]["stamp"]["nanosec"] == 7);
  CHECK(cloud["width"] == 2);
  CHECK(floats_of(cloud) ==
        std::vector<float>{4.25F, -7.75F, 2.125F, 0.75F, 4.75F, -6.75F, 2.125F + 7 * 0.25F, 1});
}

TEST_CASE("tf carries the pose as it is, stamps before 1970 too") {
  Bytes bytes;
  ros::write_tf(-1, {{1, 2, 3}, {0.5, 0.5, 0.5, -0.5}}, {"world", "truck"}, bytes);
  const json tf = test::read_message(*ros::schema_of("tf2_msgs/msg/TFMessage"), bytes);
  REQUIRE(tf["transforms"].size() == 1);
  const json& transform = tf["transforms"][0];
  CHECK(transform["header"] ==
        json{{"stamp", {{"sec", -1}, {"nanosec", 999'999'999}}}, {"frame_id", "world"}});
  CHECK(transform["child_frame_id"] == "truck");
  CHECK(transform["transform"]["translation"] == json{{"x", 1.0}, {"y", 2.0}, {"z", 3.0}});
  CHECK(transform["transform"]["rotation"] == json{{"x", 0.5}, {"y", 0.5}, {"z", 0.5}, {"w", -0.5}});
}

TEST_CASE("odometry is defined as it is sent, and has its hash") {
  const auto schema = ros::schema_of("nav_msgs/msg/Odometry");
  REQUIRE(schema);
  const json odometry = test::read_message(*schema, test::odometry_message(1'000'000'002, 3.5));
  CHECK(odometry["header"] == json{{"stamp", {{"sec", 1}, {"nanosec", 2}}}, {"frame_id", "odom"}});
  CHECK(odometry["child_frame_id"] == "base_link");
  CHECK(odometry["pose"]["pose"]["position"] == json{{"x", 3.5}, {"y", 0.0}, {"z", 0.0}});
  CHECK(odometry["pose"]["covariance"].size() == 36);
  CHECK(ros::type_hash_of("nav_msgs/msg/Odometry") ==
        "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
}

TEST_CASE("a path's poses are turned by their yaw; one of no points is a path") {
  const ipc::Plan::Point points[] = {{1, 2, 3, 0, 0, 0}, {4, 5, 6, 1.0F, 0, 0}};
  Bytes bytes;
  ros::write_path(5, {points, 2}, {}, bytes);
  const json path = test::read_message(*ros::schema_of("nav_msgs/msg/Path"), bytes);
  REQUIRE(path["poses"].size() == 2);
  const json& pose = path["poses"][1]["pose"];
  CHECK(pose["position"] == json{{"x", 4.0}, {"y", 5.0}, {"z", 6.0}});
  CHECK(pose["orientation"]["z"].get<double>() == Approx(std::sin(0.5)));
  CHECK(pose["orientation"]["w"].get<double>() == Approx(std::cos(0.5)));
  ros::write_path(5, {}, {}, bytes);
  CHECK(test::read_message(*ros::schema_of("nav_msgs/msg/Path"), bytes)["poses"].empty());
}

ipc::Health health(const char* process, ipc::HealthState state, std::int64_t mono_ns) {
  ipc::Health message{};
  ipc::set_text(message.process, process);
  message.state = static_cast<std::uint32_t>(state);
  message.mono_ns = mono_ns;
  return message;
}

TEST_CASE("diagnostics say how each process is, and what it counts") {
  constexpr std::int64_t kNow_ns = 10'000'000'000;
  auto ingest = health("gvom-ingest-top", ipc::HealthState::degraded, kNow_ns - 1);
  ipc::set_text(ingest.reason, "no packets for 1.5 s");
  ingest.counter_count = 1;
  ipc::set_text(ingest.counters[0].name, "sweeps");
  ingest.counters[0].value = 17;
  ingest.stage_count = 1;
  ipc::set_text(ingest.stages[0].name, "map");
  ingest.stages[0].p99_ms = 2.5;
  Bytes bytes;
  ros::write_diagnostics(1, {ingest, health("gvom-fusion", ipc::HealthState::ok, kNow_ns - 4'000'000'000)},
                         kNow_ns, bytes);
  const json array = test::read_message(*ros::schema_of("diagnostic_msgs/msg/DiagnosticArray"), bytes);
  REQUIRE(array["status"].size() == 2);
  const json& status = array["status"][0];
  CHECK(status["level"] == 1);
  CHECK(status["name"] == "gvom-ingest-top");
  CHECK(status["message"] == "no packets for 1.5 s");
  CHECK(status["values"][3] == json{{"key", "sweeps"}, {"value", "17"}});
  CHECK(status["values"][5] == json{{"key", "map_p99_ms"}, {"value", "2.500"}});
  CHECK(array["status"][1]["level"] == 3);
  CHECK(array["status"][1]["message"] == "silent for 4.000 s");
}

TEST_CASE("a process's state is a level") {
  using ros::DiagnosticLevel;
  const auto level = [](ipc::HealthState state) { return ros::level_of(health("p", state, 5), 5); };
  CHECK(level(ipc::HealthState::ok) == DiagnosticLevel::ok);
  CHECK(level(ipc::HealthState::starting) == DiagnosticLevel::warn);
  CHECK(level(ipc::HealthState::failed) == DiagnosticLevel::error);
  CHECK(level(static_cast<ipc::HealthState>(77)) == DiagnosticLevel::error);
}

TEST_CASE("a buffer is handed out again once nobody holds it") {
  ros::BlobPool pool;
  const ros::Blob held = pool.take();
  const auto* freed = pool.take().get();
  CHECK(freed != held.get());
  CHECK(pool.take().get() == freed);
  CHECK(pool.size() == 2);
}

TEST_CASE("a type that is only a part of others, or unknown, has no schema") {
  CHECK(!ros::schema_of("std_msgs/msg/Header"));
  CHECK(!ros::type_hash_of("std_msgs/msg/String"));
  CHECK(ros::type_hash_of("nav_msgs/msg/OccupancyGrid")->size() == 7 + 64);
}

}  // namespace
