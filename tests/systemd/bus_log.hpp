// What went over the bus, with the times that matter when a process dies.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/pool_use.hpp"
#include "ipc/waiter.hpp"

namespace gvom::test {

/// When messages of a topic were published. Times: CLOCK_MONOTONIC, ns.
struct Stream {
  std::int64_t newest_ns = 0;
  std::int64_t longest_gap_ns = 0;

  void note(std::int64_t published_ns);
  /// The longest time without a message since `begin_anew()`, until now.
  [[nodiscard]] std::int64_t gap_ns(std::int64_t now_ns) const;
  void begin_anew() { longest_gap_ns = 0; }
};

class BusLog {
 public:
  static ipc::Expected<BusLog> open(ipc::Runtime& runtime, const std::vector<std::string>& lidars);

  /// Takes what came; waits for it at most 20 ms.
  void pump();
  /// Forgets the gaps and what was said of lidars.
  void begin_anew();

  [[nodiscard]] bool is_full(
      std::uint32_t maps_of_each) const;  ///< The newest layers' window, nobody missing.
  [[nodiscard]] const ipc::LidarStatus* lidar(const std::string& name) const;  ///< In the newest layers.

  struct Process {
    pid_t pid;
    bool ok;
    std::int64_t heard_ns;
  };
  struct Lidar {
    std::string name;
    ipc::BrickMapSubscriber subscriber;
    Stream maps;
    std::int64_t named_missing_ns = 0;  ///< First time since `begin_anew()`; 0: never.
    std::uint32_t fewest_maps = 0;      ///< In a window since then.
  };

  ipc::Layers newest{};
  Stream layers;
  std::vector<Lidar> lidars;
  std::map<std::string, Process> processes;  ///< By the names in their Health.
  std::vector<std::uint32_t>
      used_chunks;  ///< In each pool; the fewest of the reports since `pool_reports` = 0.
  int pool_reports = 0;

 private:
  BusLog(ipc::LayersSubscriber layers, ipc::Subscriber<ipc::Health> health, ipc::PoolReports pools,
         ipc::Waiter waiter);
  void note_layers(std::int64_t now_ns);
  void note_pools();

  ipc::LayersSubscriber layers_in_;
  ipc::Subscriber<ipc::Health> health_in_;
  ipc::PoolReports pools_in_;
  ipc::Waiter waiter_;
};

}  // namespace gvom::test
