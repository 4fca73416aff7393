// What happened on the bus during a run: gathered from the Health and Layers messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "tools/common/health_view.hpp"
#include "tools/common/process_usage.hpp"

namespace gvom::summary {

using tools::Usage;

/// A state that is not as it should be, and how many of its Health messages said so.
struct Complaint {
  ipc::HealthState state;
  std::string reason;
  std::uint64_t messages = 0;
};

/// One process: a restarted one is another.
struct ProcessRecord {
  std::string name;
  std::uint32_t pid = 0;
  std::string backend;
  std::string backend_details;
  tools::Counters counters;           ///< Newest values, in the process's order.
  std::vector<Complaint> complaints;  ///< What it said as degraded or failed, or if it never was ok.
  bool was_ok = false;
  std::optional<Usage> usage;  ///< Newest; private_bytes is the highest seen.

  /// 0 for a counter that it does not have.
  [[nodiscard]] std::uint64_t counter(const std::string& counter_name) const;
  /// Processor time over wall time between the first and the newest look at it; 0 before the second.
  [[nodiscard]] double share_of_a_core() const;

  std::int64_t first_mono_ns = 0;
  double first_cpu_s = 0.0;
  std::int64_t newest_mono_ns = 0;
};

/// How long after the last packet of a sweep the layers were there. Milliseconds, exact (nearest rank).
struct Latency {
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

class RunRecord {
 public:
  void add(const ipc::Health& health, const std::optional<Usage>& usage, std::int64_t mono_ns);
  /// A process that publishes no Health.
  void add(const std::string& name, std::uint32_t pid, const Usage& usage, std::int64_t mono_ns);
  void add(const ipc::Layers& layers);
  void set_layers_lost(std::uint64_t lost) { layers_lost_ = lost; }

  [[nodiscard]] const std::vector<ProcessRecord>& processes() const { return processes_; }
  /// Those of the lidars: "gvom-ingest-NAME".
  [[nodiscard]] std::vector<const ProcessRecord*> ingests() const;
  [[nodiscard]] std::vector<const ProcessRecord*> fusions() const;

  [[nodiscard]] std::uint64_t layers_read() const { return layers_read_; }
  [[nodiscard]] std::uint64_t layers_lost() const { return layers_lost_; }  ///< Published, never seen here.
  [[nodiscard]] std::optional<Latency> latency() const;  ///< Nothing before the first layers.
  [[nodiscard]] double recording_s() const;              ///< From the first to the newest layers' stamp.

 private:
  ProcessRecord& process(const std::string& name, std::uint32_t pid);
  [[nodiscard]] std::vector<const ProcessRecord*> with_prefix(const std::string& prefix) const;

  std::vector<ProcessRecord> processes_;
  std::vector<std::int64_t> latencies_ns_;
  std::uint64_t layers_read_ = 0;
  std::uint64_t layers_lost_ = 0;
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t newest_stamp_ns_ = 0;
};

}  // namespace gvom::summary
