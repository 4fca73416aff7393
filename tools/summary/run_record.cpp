#include "tools/summary/run_record.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/text.hpp"

namespace gvom::summary {

namespace {

void see_usage(ProcessRecord& process, const Usage& usage, std::int64_t mono_ns) {
  if (!process.usage) {
    process.first_mono_ns = mono_ns;
    process.first_cpu_s = usage.cpu_s;
  }
  const std::uint64_t before = process.usage ? process.usage->private_bytes : 0;
  process.usage = usage;
  process.usage->private_bytes = std::max(before, usage.private_bytes);
  process.newest_mono_ns = mono_ns;
}

void see_state(ProcessRecord& process, ipc::HealthState state, const std::string& reason) {
  using ipc::HealthState;
  if (state == HealthState::stopping) return;
  if (state == HealthState::ok) {
    if (!process.was_ok) process.complaints.clear();  // everybody starts by waiting for the others
    process.was_ok = true;
    return;
  }
  for (Complaint& known : process.complaints) {
    if (known.state == state && known.reason == reason) {
      ++known.messages;
      return;
    }
  }
  process.complaints.push_back({state, reason, 1});
}

}  // namespace

std::uint64_t ProcessRecord::counter(const std::string& counter_name) const {
  for (const auto& [known, value] : counters)
    if (known == counter_name) return value;
  return 0;
}

double ProcessRecord::share_of_a_core() const {
  const double wall_s = static_cast<double>(newest_mono_ns - first_mono_ns) * 1e-9;
  return wall_s > 0 ? (usage->cpu_s - first_cpu_s) / wall_s : 0.0;
}

void RunRecord::add(const ipc::Health& health, const std::optional<Usage>& usage, std::int64_t mono_ns) {
  ProcessRecord& from = process(std::string(ipc::text_of(health.process)), health.pid);
  from.backend = ipc::text_of(health.backend);
  from.backend_details = ipc::text_of(health.backend_details);
  from.counters = tools::counters_of(health);
  see_state(from, static_cast<ipc::HealthState>(health.state), std::string(ipc::text_of(health.reason)));
  if (usage) see_usage(from, *usage, mono_ns);
}

void RunRecord::add(const std::string& name, std::uint32_t pid, const Usage& usage, std::int64_t mono_ns) {
  see_usage(process(name, pid), usage, mono_ns);
}

void RunRecord::add(const ipc::Layers& layers) {
  if (layers_read_++ == 0) first_stamp_ns_ = layers.header.stamp_ns;
  newest_stamp_ns_ = layers.header.stamp_ns;
  if (layers.mono_received_ns != 0)
    latencies_ns_.push_back(layers.mono_published_ns - layers.mono_received_ns);
}

std::vector<const ProcessRecord*> RunRecord::ingests() const {
  return with_prefix(tools::kIngestPrefix);
}

std::vector<const ProcessRecord*> RunRecord::fusions() const {
  return with_prefix("gvom-fusion");
}

std::optional<Latency> RunRecord::latency() const {
  if (latencies_ns_.empty()) return std::nullopt;
  std::vector<std::int64_t> sorted = latencies_ns_;
  std::sort(sorted.begin(), sorted.end());
  const auto nearest_rank_ms = [&](double fraction) {
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
    return static_cast<double>(sorted[std::max<std::size_t>(rank, 1) - 1]) * 1e-6;
  };
  return Latency{nearest_rank_ms(0.5), nearest_rank_ms(0.99), nearest_rank_ms(1.0)};
}

double RunRecord::recording_s() const {
  return static_cast<double>(newest_stamp_ns_ - first_stamp_ns_) * 1e-9;
}

ProcessRecord& RunRecord::process(const std::string& name, std::uint32_t pid) {
  for (ProcessRecord& known : processes_)
    if (known.pid == pid && known.name == name) return known;
  ProcessRecord& added = processes_.emplace_back();
  added.name = name;
  added.pid = pid;
  return added;
}

std::vector<const ProcessRecord*> RunRecord::with_prefix(const std::string& prefix) const {
  std::vector<const ProcessRecord*> found;
  for (const ProcessRecord& process : processes_)
    if (process.name.compare(0, prefix.size(), prefix) == 0) found.push_back(&process);
  std::sort(found.begin(), found.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
  return found;
}

}  // namespace gvom::summary
