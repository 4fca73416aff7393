// What was sampled of the processes and pools while the soak ran.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ipc/pool_use.hpp"
#include "tools/endurance/growth.hpp"
#include "tools/endurance/process_sample.hpp"

namespace gvom::endurance {

/// One start of a process.
struct Life {
  pid_t pid = 0;
  double begin_s = 0;
  bool warm = false;
  ProcessSample warm_sample{};  ///< The first one after the warm-up.
  ProcessSample newest{};
  Series private_bytes;
  Series descriptors;
  Series threads;
};

struct ProcessRecord {
  std::uint64_t starts = 0;
  std::vector<Life> lives;  ///< Those long enough to be judged, and the newest.
};

/// The pools as one broker kept them.
struct PoolLife {
  pid_t broker = 0;
  double begin_s = 0;
  std::vector<ipc::PoolUse> newest;
  std::vector<Series> used;
};

class Record {
 public:
  explicit Record(double warm_up_s) : warm_up_s_(warm_up_s) {}

  void add(const std::string& process, pid_t pid, double at_s, const ProcessSample& sample);
  void add(const std::vector<ipc::PoolUse>& pools, pid_t broker, double at_s);

  /// From the start of a process until it is looked at for growth.
  [[nodiscard]] double warm_up_s() const { return warm_up_s_; }
  [[nodiscard]] const std::map<std::string, ProcessRecord>& processes() const { return processes_; }
  [[nodiscard]] const std::vector<PoolLife>& pools() const { return pools_; }

 private:
  double warm_up_s_;
  std::map<std::string, ProcessRecord> processes_;
  std::vector<PoolLife> pools_;
};

}  // namespace gvom::endurance
