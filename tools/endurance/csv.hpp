// The samples as files, for the picture and for whoever wants to look closer.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tools/endurance/process_sample.hpp"

namespace gvom::endurance {

/// One second of the whole graph.
struct BusSample {
  double at_s = 0;
  double layers_hz = 0;
  double packets_hz = 0;  ///< That all lidars' processes counted.
  double age_ms = 0;      ///< Of the newest layers.
  double latency_p50_ms = 0;
  double latency_max_ms = 0;
  std::uint64_t chunks_used = 0;  ///< Of all pools.
  std::uint64_t rounds = 0;
  std::uint64_t clean = 0;
  std::uint64_t lost = 0;  ///< Counted so far.
};

class Csv {
 public:
  /// `FOLDER/processes.csv`, `FOLDER/bus.csv` and `FOLDER/faults.csv`.
  explicit Csv(const std::string& folder);
  void add(double at_s, const std::string& process, const ProcessSample& sample);
  void add(const BusSample& sample);
  void add_fault(double at_s, double recovered_s, const std::string& what);
  [[nodiscard]] bool is_good() const { return processes_ && bus_ && faults_; }

 private:
  std::ofstream processes_;
  std::ofstream bus_;
  std::ofstream faults_;
};

}  // namespace gvom::endurance
