#include <optional>
#include <string>

#include "services/common/dds/reader.hpp"
#include "services/common/dds/writer.hpp"
#include "tests/dds/network.hpp"
#include "tests/dds/peer_process.hpp"

using namespace gvom::dds;
using namespace gvom::dds::test;

namespace {

const std::string kHash = "RIHS01_" + std::string(64, 'a');
const Topic kCostmap{"/gvom/costmap", "nav_msgs/msg/OccupancyGrid", kHash};
const Topic kOdometry{"/odom", "nav_msgs/msg/Odometry", kHash};

std::string hex(const Guid& guid) {
  std::string text;
  for (const std::uint8_t byte : guid) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

}  // namespace

TEST_CASE("peers see the node with its readers and writers, and when they go") {
  const auto participant = join(21);
  std::optional<Writer> writer = std::move(*Writer::open(participant, kCostmap, {true, true, 1}));
  Peer peer({"21", "hear-graph"});
  const std::string node = "node /gvom bridge of " + hex(participant->guid());
  CHECK(peer.line("node") == node + " writes " + hex(writer->guid()));

  const auto reader = Reader::open(participant, kOdometry);
  REQUIRE(reader);
  const std::string with_reader = peer.line("node");
  CHECK(with_reader.rfind(node + " reads " + hex(participant->guid()).substr(0, 24), 0) == 0);

  writer.reset();
  CHECK(peer.line("node").find("writes") == std::string::npos);
}

TEST_CASE("a writer says the hash of its type, except in Humble") {
  const auto [domain, distro, user_data] =
      GENERATE_COPY(std::make_tuple(22, Distro::jazzy, "typehash=" + kHash + ";"),
                    std::make_tuple(23, Distro::humble, std::string()));
  const auto participant = join(domain, distro);
  const auto writer = Writer::open(participant, kCostmap, {true, true, 1});
  REQUIRE(writer);
  Peer peer({std::to_string(domain), "hear-graph"});
  CHECK(peer.line("writer rt/gvom/costmap") ==
        "writer rt/gvom/costmap of nav_msgs::msg::dds_::OccupancyGrid_ is " + hex(writer->guid()) +
            ", user data " + user_data);
}

TEST_CASE("a process is in a domain once, whoever opens it, and again when all have left") {
  ParticipantOptions options;
  options.domain = {24, "lo", {}, ""};
  {
    const auto first = join(24);
    CHECK(Participant::open(options).value() == first);
    options.distro = Distro::humble;
    CHECK(Participant::open(options).error() ==
          "ROS 2: domain 24: this process is in it already, with other options");
  }
  CHECK(Participant::open(options).value()->distro() == Distro::humble);
}
