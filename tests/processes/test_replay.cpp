// A replay through the processes gives the bytes of gvom-map, at any speed, however the sweeps are dealt out.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/processes/replays.hpp"
#include "tests/support/recorded_bag.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
namespace fs = std::filesystem;

namespace {

/// A scans folder with the returns of another whose y is positive, or the rest of them.
void split_scans(const std::string& from, const std::string& to, bool left) {
  fs::create_directories(to);
  fs::copy_file(from + "/times.txt", to + "/times.txt");
  const std::string scans = fs::exists(from + "/velodyne") ? from + "/velodyne" : from;
  for (const auto& entry : fs::directory_iterator(scans)) {
    if (entry.path().extension() != ".bin") continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::ofstream out(to / entry.path().filename(), std::ios::binary);
    float point[4];
    while (in.read(reinterpret_cast<char*>(point), sizeof point))
      if ((point[1] > 0) == left) out.write(reinterpret_cast<const char*>(point), sizeof point);
  }
}

/// Replays with somebody on the bus who takes the fused voxels (twice a second, the last ones in any case),
/// until they are as expected.
void check_voxels(const Vehicle& vehicle, const std::vector<Voxel>& expected) {
  Graph graph(vehicle);
  const Observer observer(vehicle.folder);
  REQUIRE(observer.is_up());
  graph.start_readers();
  graph.play_through("max");
  const bool same = eventually([&] { return observer.voxels() == expected; });
  const auto voxels = observer.voxels();
  const auto different = std::mismatch(voxels.begin(), voxels.end(), expected.begin(), expected.end());
  INFO(voxels.size() << " voxels came, expected " << expected.size() << "; the first "
                     << different.first - voxels.begin() << " are the same");
  CHECK(same);
  graph.stop();
}

void check_halves(const std::string& folder, const std::string& recording, const std::string& odometry) {
  split_scans(recording, folder + "/left", true);
  split_scans(recording, folder + "/right", false);
  const Vehicle whole = roof_lidars(folder, odometry, {{"whole", "scans:" + recording}});
  const std::string whole_map = last_map(map_offline(whole, "whole_maps"));
  const auto expected = voxels_of(whole_map);
  REQUIRE(expected.size() > 10000);
  check_voxels(whole, expected);

  const Vehicle halves = roof_lidars(
      folder, odometry, {{"left", "scans:" + folder + "/left"}, {"right", "scans:" + folder + "/right"}});
  const std::string halves_map = last_map(map_offline(halves, "halves_maps"));
  CHECK(voxels_of(halves_map) == expected);
  CHECK(differences(whole_map, halves_map) == "maps_in_window ");
  check_voxels(halves, expected);
}

}  // namespace

TEST_CASE("a simulated drive of two lidars ends in the same layers at any speed") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 1.6);
  const std::string expected = map_offline(vehicle, "maps");
  CHECK(map_count(expected) == 2 * 16);  // as many of each lidar as fusion's queue holds: none is lost
  for (const char* rate : {"1", "4", "max"}) check_replay(vehicle, rate, expected);
}

TEST_CASE("a bag of that drive ends in them as well") {
  const TemporaryFolder folder;
  Vehicle vehicle = simulated(folder.path(), 1);
  const std::string expected = map_offline(vehicle, "maps");
  record_bag(folder.path(), vehicle.lidars, folder.path() + "/bag");
  vehicle.sets.push_back("odometry.source='bag:bag?topic=/odom'");
  for (const std::string& lidar : vehicle.lidars)
    vehicle.sets.push_back("lidars." + lidar + ".source='bag:bag?topic=" + packets_topic(lidar) +
                           "&meta=" + lidar + ".json'");
  check_replay(vehicle, "max", expected);
}

TEST_CASE("the real street ends in the same layers at any speed") {
  const auto recording = kitti_recording();
  if (!recording) return;
  const TemporaryFolder folder;
  const Vehicle vehicle = kitti(folder.path(), *recording);
  const std::string expected = map_offline(vehicle, "maps");
  CHECK(map_count(expected) == 10);
  for (const char* rate : {"1", "4", "max"}) check_replay(vehicle, rate, expected);
}

TEST_CASE("the halves of a simulated sweep through two ingests are the whole through one") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  check_halves(folder.path(), scans_of_simulated(folder.path()), folder.path() + "/odometry.tum");
}

TEST_CASE("the halves of a real sweep through two ingests are the whole through one") {
  const auto recording = kitti_recording();
  if (!recording) return;
  const TemporaryFolder folder;
  check_halves(folder.path(), *recording, *recording + "/odometry.tum");
}
