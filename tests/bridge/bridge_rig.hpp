// A bridge with something to send.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/common/bridge_config.hpp"
#include "tests/bridge/ws_client.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

inline Vehicle with_bridge(Vehicle vehicle, std::uint16_t port, const std::vector<std::string>& sets) {
  for (const std::string& set : small_map()) vehicle.sets.push_back(set);
  vehicle.sets.push_back("fusion.voxel_rate_hz=10");
  vehicle.sets.push_back("bridge.foxglove.port=" + std::to_string(port));
  vehicle.sets.push_back("bridge.mcap.folder=" + vehicle.folder + "/recorded");
  vehicle.sets.push_back("bridge.mcap.topics=" + bridge::McapConfig{}.topics + ",/gvom/status");
  vehicle.sets.insert(vehicle.sets.end(), sets.begin(), sets.end());
  return vehicle;
}

/// Fusion, one lidar and the bridge, and a drive that goes round and round.
struct Rig {
  explicit Rig(const std::vector<std::string>& sets = {})
      : graph(with_bridge(front(folder.path()), port, sets)) {}

  TemporaryFolder folder;
  std::uint16_t port = free_port();
  Graph graph;
  std::unique_ptr<Program> bridge, odometry;

  static Vehicle front(const std::string& path) {
    simulated(path, 2.0);
    return front_only(path);
  }

  void start() {
    graph.start_readers();
    bridge = graph.start("gvom-bridge", {});
    odometry = graph.replay({"--rate", "1", "--loop"});
  }

  std::unique_ptr<WsClient> client() const {
    std::unique_ptr<WsClient> connected;
    eventually([&] { return (connected = WsClient::connect(port)) != nullptr; });
    return connected;
  }

  void end() {
    odometry->stop();
    graph.stop();
  }

  std::vector<std::string> recorded() const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() + "/recorded"))
      files.push_back(entry.path());
    return files;
  }
};

}  // namespace gvom::test
