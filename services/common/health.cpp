#include "services/common/health.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <unistd.h>

#include "ipc/text.hpp"

namespace gvom::services {

namespace {

constexpr std::int64_t kPeriodNs = 1'000'000'000;
constexpr int kPartsLog2 = 3;  // of an octave: 8
constexpr int kParts = 1 << kPartsLog2;

/// Below 8 each value has its bucket; above, the octave and the three bits after its leading one.
std::size_t bucket_of(std::uint64_t value) {
  if (value < kParts) return value;
  const int leading = 63 - __builtin_clzll(value);
  const std::uint64_t part = (value >> (leading - kPartsLog2)) & (kParts - 1);
  return static_cast<std::size_t>(leading - kPartsLog2 + 1) * kParts + part;
}

/// The highest value that falls into the bucket.
double upper_edge(std::size_t bucket) {
  if (bucket < kParts) return static_cast<double>(bucket);
  const int octave = static_cast<int>(bucket >> kPartsLog2) - 1;
  const auto part = static_cast<double>(bucket & (kParts - 1));
  return std::ldexp(kParts + part + 1, octave) - 1;
}

}  // namespace

std::array<char, 40> age_text(std::int64_t made_ns, std::int64_t now_ns) {
  std::array<char, 40> text{};
  if (made_ns == 0) {
    std::snprintf(text.data(), text.size(), "none yet");
  } else {
    std::snprintf(text.data(), text.size(), "newest %.0f ms old",
                  static_cast<double>(now_ns - made_ns) * 1e-6);
  }
  return text;
}

void StageHistogram::record_ns(std::int64_t duration_ns) {
  const std::int64_t duration = std::max<std::int64_t>(duration_ns, 0);
  ++buckets_[bucket_of(static_cast<std::uint64_t>(duration))];
  ++count_;
  max_ns_ = std::max(max_ns_, duration);
}

void StageHistogram::clear() {
  buckets_.fill(0);
  count_ = 0;
  max_ns_ = 0;
}

double StageHistogram::percentile_ms(double fraction) const {
  const auto rank = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    seen += buckets_[bucket];
    if (seen > 0 && seen >= rank) return std::min(upper_edge(bucket), static_cast<double>(max_ns_)) * 1e-6;
  }
  return 0.0;
}

HealthReport::HealthReport(std::string_view process, std::uint64_t config_hash) {
  ipc::set_text(message_.process, process);
  ipc::set_text(message_.version, GVOM_VERSION);
  message_.config_hash = config_hash;
  message_.pid = static_cast<std::uint32_t>(getpid());
}

std::uint64_t& HealthReport::counter(std::string_view name) {
  if (message_.counter_count == ipc::Health::kMaxCounters)
    throw std::length_error("too many health counters");
  const std::uint32_t index = message_.counter_count++;
  ipc::set_text(message_.counters[index].name, name);
  return counters_[index];
}

StageHistogram& HealthReport::stage(std::string_view name) {
  if (message_.stage_count == ipc::Health::kMaxStages) throw std::length_error("too many health stages");
  const std::uint32_t index = message_.stage_count++;
  ipc::set_text(message_.stages[index].name, name);
  return stages_[index];
}

void HealthReport::set_state(ipc::HealthState state, std::string_view reason) {
  message_.state = static_cast<std::uint32_t>(state);
  ipc::set_text(message_.reason, reason);
}

void HealthReport::set_backend(std::string_view name, std::string_view details) {
  ipc::set_text(message_.backend, name);
  ipc::set_text(message_.backend_details, details);
}

const ipc::Health& HealthReport::take(std::int64_t mono_ns) {
  const std::int64_t elapsed_ns = mono_ns - last_ns_;
  const bool has_rate = last_ns_ != 0 && elapsed_ns > 0;
  message_.rate_hz = has_rate ? static_cast<double>(products_) * 1e9 / static_cast<double>(elapsed_ns) : 0.0;
  message_.mono_ns = mono_ns;
  for (std::uint32_t i = 0; i < message_.counter_count; ++i) message_.counters[i].value = counters_[i];
  for (std::uint32_t i = 0; i < message_.stage_count; ++i) {
    ipc::Health::Stage& stage = message_.stages[i];
    stage.p50_ms = stages_[i].percentile_ms(0.50);
    stage.p99_ms = stages_[i].percentile_ms(0.99);
    stage.max_ms = stages_[i].max_ms();
    stages_[i].clear();
  }
  products_ = 0;
  last_ns_ = mono_ns;
  next_ns_ = mono_ns + kPeriodNs;
  return message_;
}

}  // namespace gvom::services
