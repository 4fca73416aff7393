// The service graph of one vehicle as real processes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/processes/program.hpp"

namespace gvom::test {

/// A vehicle with its recording.
struct Vehicle {
  std::string file;                 ///< Its YAML.
  std::vector<std::string> lidars;  ///< Sorted.
  std::string folder;               ///< Working folder of the processes; their output goes there.
  std::vector<std::string> sets;    ///< KEY=VALUE on top of the file.
  std::string variant = "";  ///< Of gvom-fusion, gvom-ingest and gvom-map: "", or "-serial" (fake device).

  /// --config and --set, then `more`.
  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const;
};

/// A UDP port that nobody uses at this moment.
std::uint16_t free_port();

/// A map small enough for a test: 128 x 128 x 32 voxels, four maps a lidar.
std::vector<std::string> small_map();

class Graph {
 public:
  /// Starts the broker; the test fails if it does not come up.
  explicit Graph(Vehicle vehicle);

  void start_fusion();
  void start_ingest(const std::string& lidar);
  void start_readers();  ///< Fusion and all ingests.
  std::unique_ptr<Program> start(const std::string& name, const std::vector<std::string>& arguments) const;
  std::unique_ptr<Program> replay(const std::vector<std::string>& arguments) const;
  /// Replays to the end; the test fails if gvom-odometry does not end well.
  void play_through(const std::string& rate) const;

  /// kill -9, and nobody starts it again.
  void lose_ingest(const std::string& lidar);

  /// Ends what runs, the broker last; the test fails if one does not end well.
  void stop(int signal = SIGTERM);

  Program& roudi() { return *roudi_; }
  Program& fusion() { return *fusion_; }
  Program& ingest(const std::string& lidar) { return *ingests_.at(lidar); }
  [[nodiscard]] const Vehicle& vehicle() const { return vehicle_; }

 private:
  Vehicle vehicle_;
  std::unique_ptr<Program> roudi_;
  std::unique_ptr<Program> fusion_;
  std::map<std::string, std::unique_ptr<Program>> ingests_;
};

}  // namespace gvom::test
