// The graph of a vehicle of one lidar among nodes of ROS 2, with the bridge and its three sinks.
#pragma once

#include <memory>
#include <string>

#include "tests/dds/peer_process.hpp"
#include "tests/processes/graph.hpp"
#include "tests/processes/observer.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::dds::test {

/// Where lidar and odometry come from.
enum class Input {
  ros2,       ///< Whoever drives; the test starts it.
  tf,         ///< The same, its pose by /tf.
  recording,  ///< A simulated drive, again and again.
};

class RobotGraph {
 public:
  /// Starts all of it in that domain; the test fails if it does not come up.
  RobotGraph(int domain, Input input);

  /// Sends so many points at 10 Hz, and odometry.
  [[nodiscard]] std::unique_ptr<Peer> drive(int points) const;
  /// Reads a topic of the bridge, "/gvom/grid_map".
  [[nodiscard]] std::unique_ptr<Peer> look(const std::string& topic, const std::string& type) const;

  [[nodiscard]] std::uint64_t of_ingest(const std::string& counter) const;
  [[nodiscard]] std::uint64_t of_bridge(const std::string& counter) const;
  [[nodiscard]] bool layers_flow() const;
  [[nodiscard]] bool recording_flows() const;
  /// Why a process is not well; empty if it is.
  [[nodiscard]] std::string reason(const std::string& process) const;
  void stop();

  gvom::test::TemporaryFolder folder;
  std::unique_ptr<gvom::test::Graph> graph;
  std::unique_ptr<gvom::test::Observer> observer;
  std::unique_ptr<gvom::test::Program> bridge;
  std::unique_ptr<gvom::test::Program> odometry;

 private:
  const std::string domain_;
  const Input input_;
};

}  // namespace gvom::dds::test
