// Grids against the ROS definitions, read by their schemas alone.
#include <catch2/catch.hpp>
#include <cmath>

#include "services/common/ros/grid_messages.hpp"
#include "services/common/ros/schemas.hpp"
#include "tests/bridge/schema_reader.hpp"
#include "tests/bridge/small_layers.hpp"

namespace {

using namespace gvom;
using Bytes = std::vector<std::uint8_t>;

TEST_CASE("cost becomes occupancy by Nav2's table") {
  CHECK(int(ros::occupancy_of(0)) == 0);
  CHECK(int(ros::occupancy_of(1)) == 1);
  CHECK(int(ros::occupancy_of(126)) == 1 + 97 * 125 / 251);
  CHECK(int(ros::occupancy_of(252)) == 98);
  CHECK(int(ros::occupancy_of(254)) == 100);
  CHECK(int(ros::occupancy_of(255)) == -1);
  for (int cost = 1; cost < 255; ++cost)
    CHECK(ros::occupancy_of(std::uint8_t(cost)) >= ros::occupancy_of(std::uint8_t(cost - 1)));
}

TEST_CASE("an occupancy grid has the bytes that were computed by hand") {
  test::SmallLayers layers(2);
  layers.bytes[12] = {0, 254, 255, 1};
  Bytes bytes;
  ros::write_occupancy_grid(layers.view, "odom", bytes);
  const Bytes expected = {
      0,  1, 0, 0,                                                             // head
      12, 0, 0, 0,    34, 0, 0,    0,    5, 0, 0, 0, 'o', 'd', 'o',  'm',  0,  // 12.000000034 s, odom
      0,  0, 0, 12,   0,  0, 0,    34,   0, 0, 0,                              // padded to 4; map_load_time
      0,  0, 0, 0x3f, 2,  0, 0,    0,    2, 0, 0, 0,                           // 0.5 m, 2 x 2: 40 bytes
      0,  0, 0, 0,    0,  0, 0x10, 0xc0, 0, 0, 0, 0, 0,   0,   0x20, 0x40,     // x -4 m, y 8 m
      0,  0, 0, 0,    0,  0, 0x0c, 0x40, 0, 0, 0, 0, 0,   0,   0,    0,        // z 3.5 m; turned by
      0,  0, 0, 0,    0,  0, 0,    0,    0, 0, 0, 0, 0,   0,   0,    0,        // nothing:
      0,  0, 0, 0,    0,  0, 0xf0, 0x3f, 4, 0, 0, 0, 0,   100, 0xff, 1};       // w 1; four cells
  CHECK(bytes == expected);
}

TEST_CASE("a grid map's values run from the corner of greatest x and y") {
  test::SmallLayers layers(8);
  Bytes bytes;
  ros::write_grid_map(layers.view, {LayerId::slope, LayerId::cost}, "map", bytes);
  const auto map = test::read_message(*ros::schema_of("grid_map_msgs/msg/GridMap"), bytes);
  CHECK(map["header"]["frame_id"] == "map");
  CHECK(map["info"]["resolution"] == 0.5);
  CHECK(map["info"]["length_x"] == 4.0);
  CHECK(map["info"]["pose"]["position"]["x"] == -4.0 + 2.0);
  CHECK(map["info"]["pose"]["position"]["y"] == 8.0 + 2.0);
  CHECK(map["layers"] == nlohmann::json{"slope", "cost"});
  CHECK(map["basic_layers"] == nlohmann::json{"slope"});
  const auto& slope = map["data"][0];
  CHECK(slope["layout"]["dim"][0] == nlohmann::json{{"label", "column_index"}, {"size", 8}, {"stride", 64}});
  CHECK(slope["layout"]["dim"][1] == nlohmann::json{{"label", "row_index"}, {"size", 8}, {"stride", 8}});
  REQUIRE(slope["data"].size() == 64);
  // Index (row r, column c) of grid_map is at data[c * 8 + r]; its cell is x = 7 - r, y = 7 - c of ours.
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < 8; ++c) {
      CHECK(slope["data"][c * 8 + r] == 400 + (7 - c) * 8 + (7 - r));
      CHECK(map["data"][1]["data"][c * 8 + r] == 12 + (7 - c) * 8 + (7 - r));
    }
  CHECK(map["outer_start_index"] == 0);
}

TEST_CASE("Foxglove's grid has every layer of every column, by its fields") {
  test::SmallLayers layers(8);
  Bytes bytes;
  for (int again = 0; again < 2; ++again) ros::write_foxglove_grid(layers.view, "odom", bytes);
  const auto grid = test::read_message(*ros::schema_of("foxglove_msgs/msg/Grid"), bytes);
  CHECK(grid["timestamp"] == nlohmann::json{{"sec", 12}, {"nanosec", 34}});
  CHECK(grid["pose"]["position"]["y"] == 8.0);
  CHECK(grid["column_count"] == 8);
  CHECK(grid["cell_size"] == nlohmann::json{{"x", 0.5}, {"y", 0.5}});
  const auto data = grid["data"].get<Bytes>();
  const auto row_bytes = grid["row_stride"].get<std::size_t>(),
             cell_bytes = grid["cell_stride"].get<std::size_t>();
  REQUIRE(data.size() == 8 * row_bytes);
  REQUIRE(grid["fields"].size() == 13);
  for (std::size_t l = 0; l < 13; ++l) {
    const auto& field = grid["fields"][l];
    CHECK(field["name"] == ros::kLayerNames[l]);
    for (std::size_t i = 0; i < 64; ++i) {
      const std::size_t at = i / 8 * row_bytes + i % 8 * cell_bytes + field["offset"].get<std::size_t>();
      if (field["type"] == 1) {
        CHECK(data[at] == layers.bytes[l][i]);
      } else {
        REQUIRE(field["type"] == 7);
        float value;
        std::memcpy(&value, data.data() + at, sizeof value);
        const float expected = layers.floats[l][i];
        CHECK((std::isnan(expected) ? std::isnan(value) : value == expected));
      }
    }
  }
}

TEST_CASE("a buffer that is warm stays where it is") {
  test::SmallLayers layers(64);
  Bytes bytes;
  ros::write_foxglove_grid(layers.view, "odom", bytes);
  const auto* place = bytes.data();
  const Bytes first = bytes;
  ros::write_grid_map(layers.view, {LayerId::height}, "odom", bytes);
  ros::write_foxglove_grid(layers.view, "odom", bytes);
  CHECK(bytes.data() == place);
  CHECK(std::memcmp(bytes.data(), first.data(), first.size()) == 0);
}

}  // namespace
