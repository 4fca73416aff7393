#include <catch2/catch.hpp>

#include "services/common/dds/graph.hpp"
#include "services/common/dds/names.hpp"

using namespace gvom::dds;

TEST_CASE("topics and types on the wire are those of ROS 2") {
  CHECK(topic_on_wire("/gvom/costmap").value() == "rt/gvom/costmap");
  CHECK(topic_on_wire("/tf").value() == "rt/tf");
  CHECK(type_on_wire("nav_msgs/msg/OccupancyGrid").value() == "nav_msgs::msg::dds_::OccupancyGrid_");
}

TEST_CASE("names that ROS refuses are refused") {
  for (const char* name : {"", "/", "costmap", "~/costmap", "/gvom/", "//costmap", "/gvom//costmap", "/2d",
                           "/a-b", "/a b", "/\xc3\xa4"}) {
    INFO(name);
    CHECK_FALSE(topic_on_wire(name));
  }
  CHECK_FALSE(topic_on_wire("/" + std::string(200, 'a')));
  CHECK(topic_on_wire("/" + std::string(199, 'a')));
  for (const char* type : {"", "OccupancyGrid", "nav_msgs/OccupancyGrid", "nav_msgs/srv/GetMap",
                           "/msg/OccupancyGrid", "nav_msgs/msg/", "nav_msgs/msg/A/B"}) {
    INFO(type);
    CHECK_FALSE(type_on_wire(type));
  }
  CHECK(topic_on_wire("/a-b").error() ==
        "topic '/a-b' has a part that is not letters, digits and underscores, a digit not first");
}

TEST_CASE("a node's full name is its namespace and its name") {
  CHECK(node_name("/gvom").value().space == "/");
  CHECK(node_name("/gvom").value().name == "gvom");
  CHECK(node_name("/front/gvom/bridge").value().space == "/front/gvom");
  CHECK(node_name("/front/gvom/bridge").value().name == "bridge");
  CHECK_FALSE(node_name("gvom"));
}

TEST_CASE("the graph's message has gids of 24 bytes in Humble, of 16 in Jazzy") {
  NodeEntities entities;
  entities.participant.fill(0xaa);
  entities.node = {"/", "gvom"};
  entities.writers.emplace_back();
  entities.writers[0].fill(0xbb);

  // head, gid, one node, "/" and "gvom" with their NULs (3 bytes to the next word each), no reader, one
  // writer
  const auto size = [](std::size_t gid) { return 4 + gid + 4 + (4 + 2 + 2) + (4 + 5 + 3) + 4 + 4 + gid; };
  const auto jazzy = graph_message(entities, Distro::jazzy);
  const auto humble = graph_message(entities, Distro::humble);
  CHECK(jazzy->size() == size(16));
  CHECK(humble->size() == size(24));
  CHECK((*jazzy)[19] == 0xaa);
  CHECK((*jazzy)[20] == 1);  // nodes
  CHECK((*humble)[20] == 0);
  CHECK((*humble)[28] == 1);
  CHECK(jazzy->back() == 0xbb);
  CHECK(humble->back() == 0);
}
