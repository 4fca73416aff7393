// gvom-map of a bag: the bytes are those of the same recording as pcap and TUM.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "services/common/odometry_file.hpp"
#include "services/ingest/pcap_reader.hpp"
#include "tests/support/db3_builder.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/map/bag_sources.hpp"
#include "tools/map/map_writer.hpp"
#include "tools/map/progress.hpp"
#include "tools/sim/scenes/trail.hpp"
#include "tools/sim/simulate.hpp"

using namespace gvom;
using namespace gvom::test;
namespace fs = std::filesystem;

namespace {

services::VehicleConfig one_lidar() {
  services::VehicleConfig vehicle;
  vehicle.mapper.map.size_xy = 64;
  vehicle.lidars.resize(1);
  vehicle.lidars[0].name = "front";
  vehicle.lidars[0].geometry.T_base_sensor = Eigen::Translation3d(0.45, 0.0, 0.95);
  return vehicle;
}

void record(const std::string& folder) {
  sim::RecordingOptions options;
  options.seconds = 0.4;
  options.threads = 2;
  const sim::World world(sim::make_trail({1, sim::path_length_m(one_lidar(), options), 5.0}));
  REQUIRE(sim::simulate(one_lidar(), world, options, folder));
}

Octets pose_message(const StampedPose& pose) {
  CdrWriter cdr;
  cdr.header(pose.stamp_ns, "odom").text("base_link");
  const Eigen::Vector3d& p = pose.T_odom_base.translation_m;
  const Eigen::Quaterniond& q = pose.T_odom_base.rotation;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) cdr.add(value);
  return cdr.bytes();
}

/// The recording as a split bag: packets in SQLite, odometry in MCAP, by a recorder whose clock is late.
void record_bag(const std::string& folder, const std::string& bag) {
  constexpr std::int64_t kLate_ns = 60'000'000'000;
  fs::create_directory(bag);
  ingest::SourceState state;
  auto pcap = ingest::PcapReader::open(folder + "/front.pcap", {}, state);
  REQUIRE(pcap.has_value());
  Db3Builder packets(bag + "/bag_0.db3");
  const int topic = packets.topic("/ouster/lidar_packets", "ouster_sensor_msgs/msg/PacketMsg");
  ingest::Packet packet;
  std::int64_t log_ns = kLate_ns;
  while ((*pcap)->next(packet, std::chrono::milliseconds(0)).value() == ingest::PacketEvent::packet)
    packets.add(topic, ++log_ns, ouster_message(Octets(packet.data, packet.data + packet.size)));
  McapBuilder odometry({"zstd", 10});
  const auto channel = odometry.topic("/odom", "nav_msgs/msg/Odometry");
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source("tum:" + folder + "/odometry.tum", warnings);
  REQUIRE(poses.has_value());
  for (const StampedPose& pose : *poses) odometry.add(channel, pose.stamp_ns + kLate_ns, pose_message(pose));
  odometry.write(bag + "/bag_1.mcap");
}

int map(const services::VehicleConfig& config, const tools::MapWriterOptions& options) {
  auto mapper = tools::OfflineMapper::open(config, config.odometry.source);
  INFO((mapper ? "" : mapper.error().what));
  REQUIRE(mapper.has_value());
  auto maps = tools::MapWriter::open(options, *mapper, config);
  REQUIRE(maps.has_value());
  tools::MappedSweep sweep;
  while (mapper->next(sweep).value()) REQUIRE(maps->take(sweep).has_value());
  REQUIRE(maps->finish().has_value());
  return maps->maps();
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("a bag's maps are those of the same packets in a pcap, to the byte") {
  TemporaryFolder folder;
  const std::string& path = folder.path();
  record(path);
  record_bag(path, path + "/bag");
  auto config = one_lidar();
  const std::string meta = "meta=" + path + "/front.json";
  config.lidars[0].source = "ouster:" + path + "/front.pcap?" + meta;
  config.odometry.source = "tum:" + path + "/odometry.tum";
  const int maps = map(config, {path + "/a", false, 0, "", ""});
  CHECK(maps >= 3);

  config.lidars[0].source = "bag:?topic=/ouster/lidar_packets&" + meta;
  config.odometry.source = "bag:?topic=/odom";
  CHECK(tools::fill_bag(config, path + "/bag") == 2);
  CHECK(map(config, {path + "/b", false, 0, "", ""}) == maps);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path + "/a")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    INFO(entry.path());
    CHECK(read_file(entry.path()) ==
          read_file(fs::path(path + "/b") / fs::relative(entry.path(), path + "/a")));
  }
  CHECK(files == 14 * maps);

  tools::MapWriterOptions rare{path + "/c", false, 0.25, path + "/pictures", ""};
  CHECK(map(config, rare) == 2);  // the first, one after 0.25 s or the last
  CHECK(read_file(path + "/c/000000/cost.npy") == read_file(path + "/a/000000/cost.npy"));
  CHECK(fs::file_size(path + "/pictures/montage.png") > 1000);
  CHECK(fs::exists(path + "/pictures/cost.png"));
}

TEST_CASE("--bag fills the sources that leave it open, and no others") {
  services::VehicleConfig config;
  config.lidars.resize(3);
  config.lidars[0].source = "bag:?topic=/points";
  config.lidars[1].source = "bag:/old?topic=/points";
  config.lidars[2].source = "scans:folder";
  config.odometry.source = "bag:?tf=odom/base_link";
  CHECK(tools::fill_bag(config, "/data/run 7") == 2);
  CHECK(config.lidars[0].source == "bag:/data/run 7?topic=/points");
  CHECK(config.lidars[1].source == "bag:/old?topic=/points");
  CHECK(config.lidars[2].source == "scans:folder");
  CHECK(config.odometry.source == "bag:/data/run 7?tf=odom/base_link");
}

TEST_CASE("progress says how far, of how much, and how fast") {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  CHECK(tools::progress_text(TimeSpan{0, 280 * kSecond_ns}, {8 * kSecond_ns, 118 * kSecond_ns}, 1100, 55.0) ==
        "42 %: 118 of 280 s, 1100 sweeps mapped, 2.0 times real time");
  CHECK(tools::progress_text({}, {0, 5 * kSecond_ns}, 50, 0.0) == "5 s, 50 sweeps mapped");
}
