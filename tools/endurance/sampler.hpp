// Samples everything once a second, into the record and into files.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "services/common/health.hpp"
#include "tools/endurance/csv.hpp"
#include "tools/endurance/health_watch.hpp"
#include "tools/endurance/notes.hpp"
#include "tools/endurance/record.hpp"

namespace gvom::endurance {

class Sampler {
 public:
  /// `folder`: for the files.
  Sampler(const std::string& folder, double warm_up_s) : record_(warm_up_s), csv_(folder) {}

  void begin(std::int64_t now_ns);
  void take(const LayersNote& note);
  /// `steady`: the window is full and no fault is made, so that pools can be compared with later ones.
  void take(const std::vector<ipc::PoolUse>& pools, std::int64_t now_ns, bool steady);

  /// `processes`: who is looked at. Does nothing until a second has passed.
  void sample(std::int64_t now_ns, const std::vector<std::pair<std::string, pid_t>>& processes,
              const HealthWatch& health, const RoundBook& rounds);
  void add_fault(double at_s, double recovered_s, const std::string& what) {
    csv_.add_fault(at_s, recovered_s, what);
  }
  /// A line for people, once in ten seconds.
  void say_progress(std::int64_t now_ns);

  [[nodiscard]] double run_s(std::int64_t now_ns) const;
  [[nodiscard]] const Record& record() const { return record_; }
  [[nodiscard]] const services::StageHistogram& latency() const { return latency_; }
  [[nodiscard]] std::uint64_t layers() const { return layers_; }
  [[nodiscard]] bool files_are_good() const { return csv_.is_good(); }

 private:
  Record record_;
  Csv csv_;
  std::int64_t begin_ns_ = 0;
  std::int64_t sampled_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  services::StageHistogram latency_;
  services::StageHistogram latency_now_;  // since the last sample
  std::uint64_t layers_ = 0;
  std::uint64_t layers_before_ = 0;
  std::uint64_t packets_before_ = 0;
  std::int64_t newest_layers_ns_ = 0;
  std::uint64_t chunks_used_ = 0;
  BusSample newest_;
};

}  // namespace gvom::endurance
