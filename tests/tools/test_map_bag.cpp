// gvom-map of a bag: the bytes are those of the same recording as pcap and TUM.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/recorded_bag.hpp"
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
  record_bag(path, {"front"}, path + "/bag");
  auto config = one_lidar();
  const std::string meta = "meta=" + path + "/front.json";
  config.lidars[0].source = "ouster:" + path + "/front.pcap?" + meta;
  config.odometry.source = "tum:" + path + "/odometry.tum";
  const int maps = map(config, {path + "/a", false, 0, "", ""});
  CHECK(maps >= 3);

  config.lidars[0].source = "bag:?topic=/front/lidar_packets&" + meta;
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

TEST_CASE("sweeps of a recording that repeats itself are not mapped again, and it is said why") {
  TemporaryFolder folder;
  const std::string& path = folder.path();
  record(path);
  constexpr std::size_t kPcapHeader = 24;
  const std::string pcap = read_file(path + "/front.pcap");
  std::ofstream(path + "/front.pcap", std::ios::binary | std::ios::app) << pcap.substr(kPcapHeader);
  auto config = one_lidar();
  config.lidars[0].source = "ouster:" + path + "/front.pcap?meta=" + path + "/front.json";
  auto mapper = tools::OfflineMapper::open(config, "tum:" + path + "/odometry.tum");
  REQUIRE(mapper.has_value());
  tools::MappedSweep sweep;
  std::uint64_t maps = 0;
  while (mapper->next(sweep).value()) ++maps;
  const tools::RefusedMaps& refused = mapper->lidars()[0].refused;
  CHECK(maps >= 3);
  CHECK(refused.all() == refused.duplicate);
  CHECK(refused.duplicate >= 3);
  const auto lines = tools::explain(refused);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].find(std::to_string(refused.duplicate) +
                      " sweeps not mapped: there is a map of that time already") == 0);
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
