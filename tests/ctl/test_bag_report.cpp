// gvomctl bag: what it finds in a bag, and lines of a vehicle's file that load.
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <iterator>

#include "services/common/config_file.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/ctl/bag_report.hpp"
#include "tools/ctl/commands.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Contains;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kNoon_ns = 1'700'000'000 * kSecond_ns;
constexpr std::int64_t kTaiUtc_ns = 37 * kSecond_ns;

/// Of a profile with header, 4 kB; its first column's time is at byte 32.
Octets ouster_packet(std::int64_t time_ns) {
  Octets packet(4096, 0);
  std::memcpy(packet.data() + 32, &time_ns, sizeof time_ns);
  return packet;
}

/// A VLP-16's, at `time_ns` of its clock.
Octets velodyne_packet_at(std::int64_t time_ns) {
  Octets packet(1206, 0);
  const auto time_us = static_cast<std::uint32_t>(time_ns / 1000 % 3'600'000'000);
  std::memcpy(packet.data() + 1200, &time_us, sizeof time_us);
  packet[1204] = 0x37;
  packet[1205] = 0x22;
  return packet;
}

Octets cloud_without_times(std::int64_t stamp_ns) {
  return cloud_message(stamp_ns, {{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}}, 12}, Octets(24, 0));
}

struct Bag {
  TemporaryFolder folder;
  McapBuilder file{{"zstd", 16}};
  [[nodiscard]] std::string path() const { return folder.path() + "/a.mcap"; }

  ctl::BagFacts facts() {
    file.write(path());
    auto read = ctl::read_bag_facts(path());
    INFO((read ? "" : read.error()));
    REQUIRE(read.has_value());
    return std::move(*read);
  }
};

/// A robot: an Ouster by TAI with its IMU, a Velodyne and a driver's cloud by UTC, odometry at 10 Hz for 2 s.
void record_robot(Bag& bag) {
  const auto lidar = bag.file.topic("/ouster/lidar_packets", "ouster_sensor_msgs/msg/PacketMsg");
  const auto imu = bag.file.topic("/ouster/imu_packets", "ouster_sensor_msgs/msg/PacketMsg");
  const auto metadata = bag.file.topic("/ouster/metadata", "std_msgs/msg/String");
  const auto velodyne = bag.file.topic("/velodyne_packets", "velodyne_msgs/msg/VelodyneScan");
  const auto cloud = bag.file.topic("/points", "sensor_msgs/msg/PointCloud2");
  const auto odometry = bag.file.topic("/odom", "nav_msgs/msg/Odometry");
  bag.file.add(metadata, kNoon_ns, CdrWriter().text("{\"prod_sn\": 1}").bytes());
  for (int i = 0; i < 21; ++i) {
    const std::int64_t now_ns = kNoon_ns + i * kSecond_ns / 10;
    bag.file.add(lidar, now_ns, ouster_message(ouster_packet(now_ns - 2'000'000 + kTaiUtc_ns)));
    bag.file.add(imu, now_ns, ouster_message(Octets(48, 0)));
    bag.file.add(velodyne, now_ns,
                 velodyne_message(now_ns - 3'000'000, {velodyne_packet_at(now_ns - 3'000'000)}));
    bag.file.add(cloud, now_ns, cloud_without_times(now_ns - 5'000'000));
    bag.file.add(odometry, now_ns, odometry_message(now_ns - 1'000'000, i));
  }
}

}  // namespace

TEST_CASE("topics with counts, rates and how late the recorder was") {
  Bag bag;
  record_robot(bag);
  const std::string table = ctl::bag_table(bag.facts());
  CHECK_THAT(table, Contains("/odom                  nav_msgs/msg/Odometry"));
  CHECK_THAT(table, Contains("21     10.0/s      2.0 s  0.001 to 0.001 s"));
  CHECK_THAT(table, Contains("21     10.0/s      2.0 s  -36.998 to -36.998 s"));  // the Ouster's
  CHECK_THAT(table, Contains("21     10.0/s      2.0 s  0.003 to 0.003 s"));      // the Velodyne's own time
  CHECK_THAT(table, Contains(" 1          -      0.0 s  -"));                     // the metadata
}

TEST_CASE("clocks that differ from the odometry's, and clouds without times, are told") {
  Bag bag;
  record_robot(bag);
  CHECK(ctl::bag_problems(bag.facts()) ==
        std::vector<std::string>{
            "/ouster/lidar_packets: its clock is 37.00 s ahead of /odom's (that is TAI - UTC): "
            "lidars.NAME.clock_offset_s: -37.00 would put that right, or lidars.NAME.clock: arrival",
            "/points: its points have no times: they can't be deskewed"});
}

TEST_CASE("the lines are a vehicle's file that loads, and leave the bag open") {
  Bag bag;
  record_robot(bag);
  const std::string path = bag.folder.path() + "/vehicle.yaml";
  std::ofstream(path) << ctl::vehicle_lines(bag.facts());
  const auto config = services::load_vehicle_config(path, {});
  INFO((config ? "" : config.error().text()));
  REQUIRE(config.has_value());
  CHECK(config->odometry.source == "bag:?topic=/odom");
  REQUIRE(config->lidars.size() == 3);
  CHECK(config->lidars[0].source == "bag:?topic=/ouster/lidar_packets&meta=ouster_metadata.json");
  CHECK(config->lidars[1].source == "bag:?topic=/points&deskew=off");
  CHECK(config->lidars[2].source == "bag:?topic=/velodyne_packets&model=VLP-16");
}

TEST_CASE("odometry by tf, a looped recording, and a bag without anything for gvom") {
  Bag bag;
  const auto tf = bag.file.topic("/tf", "tf2_msgs/msg/TFMessage");
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 3; ++i)
      bag.file.add(tf, kNoon_ns + (round * 3 + i) * kSecond_ns,
                   tf_message({{"odom", "base_footprint", i * kSecond_ns}, {"map", "odom", i * kSecond_ns}}));
  auto facts = bag.facts();
  CHECK_THAT(ctl::vehicle_lines(facts), Contains("source: bag:?tf=odom/base_footprint\n"));
  CHECK(ctl::bag_problems(facts) ==
        std::vector<std::string>{
            "no lidar in it that is read: neither packets of an Ouster or a Velodyne nor clouds",
            "/tf: its time goes back 1 times: a recording that was looped?"});
  Bag empty;
  empty.file.topic("/camera", "sensor_msgs/msg/Image");
  CHECK(ctl::bag_problems(empty.facts()).size() == 2);
}

TEST_CASE("an Ouster's metadata comes out of the bag as it went in") {
  Bag bag;
  record_robot(bag);
  bag.file.write(bag.path());
  CHECK(ctl::show_bag(bag.path(), bag.folder.path()) == 0);
  std::ifstream file(bag.folder.path() + "/ouster_metadata.json");
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == "{\"prod_sn\": 1}");
  CHECK(ctl::show_bag(bag.folder.path() + "/none", "") == 65);
}
