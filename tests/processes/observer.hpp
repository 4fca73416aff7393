// A process that watches the bus for a test: layers, health, voxels, and what the pools hold.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ipc/brick_map.hpp"
#include "ipc/messages.hpp"
#include "tests/ipc/processes.hpp"
#include "tests/processes/results.hpp"

namespace gvom::test {

/// The observed voxels of a map in z, y, x order.
std::vector<Voxel> observed_voxels(const ipc::BrickMapSample& map);

class Observer {
 public:
  /// Joins the bus; on it when the constructor returns. Files go to `folder`.
  explicit Observer(const std::string& folder);
  ~Observer();
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  [[nodiscard]] bool is_up() const { return up_; }
  [[nodiscard]] std::uint64_t layers() const;  ///< That came.
  [[nodiscard]] ipc::Layers newest_layers() const;
  /// A counter as the process's last Health has it; 0 if there was none yet.
  [[nodiscard]] std::uint64_t counter(const std::string& process, const std::string& name) const;
  /// The counters called drop_* of a process's last Health that are not zero, with their values.
  [[nodiscard]] std::string drops(const std::string& process) const;
  /// A process's last Health; nothing if there was none yet.
  [[nodiscard]] std::optional<ipc::Health> health(const std::string& process) const;
  /// Whether these words were in the reason of any Health of the process so far.
  [[nodiscard]] bool has_said(const std::string& process, const std::string& words) const;
  /// What computes, "NAME: DETAILS", as the process's last Health has it; empty if there was none yet.
  [[nodiscard]] std::string backend(const std::string& process) const;
  /// Waits for a process's Health of this state.
  [[nodiscard]] bool sees(const std::string& process, ipc::HealthState state) const;
  /// Chunks in use in each payload pool, by size, as of the broker's next report but one.
  [[nodiscard]] std::vector<std::uint32_t> used_chunks() const;
  /// The newest fused voxels in z, y, x order.
  [[nodiscard]] std::vector<Voxel> voxels() const;

 private:
  static constexpr int kMostProcesses = 8;
  static constexpr int kMostPools = 8;
  static constexpr std::size_t kMostSaid = 1 << 18;
  struct Board {
    pthread_mutex_t mutex;
    std::uint64_t layers;
    ipc::Layers newest;
    int processes;
    ipc::Health health[kMostProcesses];
    std::size_t said_size;
    char said[kMostSaid];  // "PROCESS: REASON" lines, where a reason is a new one
    std::uint64_t pool_reports;
    int pools;
    std::uint32_t used_chunks[kMostPools];
  };

  void watch();
  void note(const ipc::Health& health);
  template <class Read>
  auto read(Read what) const;

  std::string folder_;
  Board* board_;
  ipc::test::Step up_step_;
  ipc::test::Child child_;
  bool up_ = false;
};

}  // namespace gvom::test
