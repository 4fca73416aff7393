#include "tools/endurance/sampler.hpp"

#include <algorithm>
#include <cstdio>

#include "ipc/broker_probe.hpp"
#include "tools/common/health_view.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kProgress_ns = 10 * kSecond_ns;

std::uint64_t packets_of(const HealthWatch& health) {
  std::uint64_t packets = 0;
  for (const std::string& process : health.expected()) {
    const ipc::Health* const newest = health.newest(process);
    if (newest == nullptr) continue;
    for (const auto& [name, value] : tools::counters_of(*newest))
      if (name == "packets") packets += value;
  }
  return packets;
}

/// Packets, sweeps, maps: not the columns that were in them.
std::uint64_t sum_of(const std::map<std::string, std::uint64_t>& losses) {
  std::uint64_t sum = 0;
  for (const auto& [what, count] : losses)
    if (what.find(" column_") == std::string::npos) sum += count;
  return sum;
}

}  // namespace

void Sampler::begin(std::int64_t now_ns) {
  begin_ns_ = sampled_ns_ = now_ns;
  next_progress_ns_ = now_ns + kProgress_ns;
}

double Sampler::run_s(std::int64_t now_ns) const {
  return begin_ns_ == 0 ? 0 : static_cast<double>(now_ns - begin_ns_) * 1e-9;
}

void Sampler::take(const LayersNote& note) {
  ++layers_;
  newest_layers_ns_ = note.published_mono_ns;
  latency_.record_ns(note.published_mono_ns - note.received_mono_ns);
  latency_now_.record_ns(note.published_mono_ns - note.received_mono_ns);
}

void Sampler::take(const std::vector<ipc::PoolUse>& pools, std::int64_t now_ns, bool steady) {
  chunks_used_ = 0;
  for (const ipc::PoolUse& pool : pools) chunks_used_ += pool.used;
  if (begin_ns_ != 0 && steady) record_.add(pools, ipc::broker_pid().value_or(0), run_s(now_ns));
}

void Sampler::sample(std::int64_t now_ns, const std::vector<std::pair<std::string, pid_t>>& processes,
                     const HealthWatch& health, const RoundBook& rounds) {
  if (begin_ns_ == 0 || now_ns < sampled_ns_ + kSecond_ns) return;
  const double elapsed_s = static_cast<double>(now_ns - sampled_ns_) * 1e-9;
  sampled_ns_ = now_ns;
  newest_.at_s = run_s(now_ns);
  for (const auto& [process, pid] : processes) {
    const auto sample = sample_process(pid);
    if (!sample) continue;
    record_.add(process, pid, newest_.at_s, *sample);
    csv_.add(newest_.at_s, process, *sample);
  }
  const std::uint64_t packets = packets_of(health);
  newest_.layers_hz = static_cast<double>(layers_ - std::exchange(layers_before_, layers_)) / elapsed_s;
  const std::uint64_t before = std::min(packets, std::exchange(packets_before_, packets));
  newest_.packets_hz = static_cast<double>(packets - before) / elapsed_s;
  newest_.age_ms = layers_ == 0 ? 0 : static_cast<double>(now_ns - newest_layers_ns_) * 1e-6;
  newest_.latency_p50_ms = latency_now_.percentile_ms(0.5);
  newest_.latency_max_ms = latency_now_.max_ms();
  latency_now_.clear();
  newest_.chunks_used = chunks_used_;
  newest_.rounds = rounds.rounds();
  newest_.clean = rounds.clean();
  newest_.lost = sum_of(health.losses());
  csv_.add(newest_);
}

void Sampler::say_progress(std::int64_t now_ns) {
  if (begin_ns_ == 0 || now_ns < next_progress_ns_) return;
  next_progress_ns_ += kProgress_ns;
  double private_bytes = 0;
  for (const auto& [process, known] : record_.processes())
    private_bytes += static_cast<double>(known.lives.back().newest.private_bytes);
  std::printf(
      "%6.0f s: %llu rounds, %llu clean; %.1f layers/s, latency %.1f ms, at most %.1f; %.1f MB; "
      "%llu chunks; lost and counted: %llu\n",
      newest_.at_s, static_cast<unsigned long long>(newest_.rounds),
      static_cast<unsigned long long>(newest_.clean), newest_.layers_hz, newest_.latency_p50_ms,
      newest_.latency_max_ms, private_bytes * 1e-6, static_cast<unsigned long long>(newest_.chunks_used),
      static_cast<unsigned long long>(newest_.lost));
  std::fflush(stdout);
}

}  // namespace gvom::endurance
