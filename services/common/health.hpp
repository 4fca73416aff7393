// What a process tells of itself at 1 Hz: assembles ipc::Health.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ipc/messages.hpp"

namespace gvom::services {

/// "newest 12 ms old", for a status line; "none yet" where `made_ns` is 0. Both of CLOCK_MONOTONIC.
std::array<char, 40> age_text(std::int64_t made_ns, std::int64_t now_ns);

/// How long a stage took, since the last message. Buckets of an eighth of an octave: percentiles are the
/// upper edge of their bucket, at most 12.5 % above the truth and never above the maximum, which is exact.
class StageHistogram {
 public:
  void record_ns(std::int64_t duration_ns);
  void clear();

  [[nodiscard]] double percentile_ms(double fraction) const;  ///< 0 if nothing was recorded.
  [[nodiscard]] double max_ms() const { return static_cast<double>(max_ns_) * 1e-6; }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  static constexpr int kBuckets = 496;  // 0 .. 7 ns one by one, then 8 an octave up to 2^64

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

/// One for each process, used from its working loop. Nothing here allocates.
class HealthReport {
 public:
  /// `process` is the runtime name, e.g. "gvom-ingest-top"; `config_hash` of what concerns it
  /// (config_concerns.hpp).
  HealthReport(std::string_view process, std::uint64_t config_hash);

  /// A new counter; the reference stays valid. Throws std::length_error beyond Health::kMaxCounters (a
  /// defect).
  std::uint64_t& counter(std::string_view name);
  /// A new stage; the reference stays valid. Throws std::length_error beyond Health::kMaxStages (a defect).
  StageHistogram& stage(std::string_view name);

  void set_state(ipc::HealthState state, std::string_view reason = {});  ///< Over-long reasons are cut.
  /// What computes, and why and on what; over-long details are cut.
  void set_backend(std::string_view name, std::string_view details);
  void set_ground(const ipc::Ground& ground) { message_.ground = ground; }
  void count_product() { ++products_; }  ///< One more of what the process makes: rate_hz.

  [[nodiscard]] ipc::HealthState state() const { return static_cast<ipc::HealthState>(message_.state); }
  [[nodiscard]] std::string_view reason() const { return message_.reason; }

  /// True once a second of CLOCK_MONOTONIC, the first time at once.
  [[nodiscard]] bool due(std::int64_t mono_ns) const { return mono_ns >= next_ns_; }

  /// The message for now; what was gathered since the last one begins anew. `header` is left to the
  /// publisher.
  const ipc::Health& take(std::int64_t mono_ns);

 private:
  std::array<std::uint64_t, ipc::Health::kMaxCounters> counters_{};
  std::array<StageHistogram, ipc::Health::kMaxStages> stages_{};
  ipc::Health message_{};
  std::uint64_t products_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t next_ns_ = 0;
};

}  // namespace gvom::services
