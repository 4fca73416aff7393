#include "services/common/ros/diagnostics_message.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "ipc/text.hpp"
#include "services/common/ros/message_parts.hpp"

namespace gvom::ros {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

std::string decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

Values values_of(const ipc::Health& health) {
  Values values = {{"rate_hz", decimal(health.rate_hz)},
                   {"version", std::string(ipc::text_of(health.version))},
                   {"backend", std::string(ipc::text_of(health.backend))}};
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(health.counter_count, ipc::Health::kMaxCounters); ++i)
    values.emplace_back(ipc::text_of(health.counters[i].name), std::to_string(health.counters[i].value));
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(health.stage_count, ipc::Health::kMaxStages); ++i) {
    const std::string name(ipc::text_of(health.stages[i].name));
    values.emplace_back(name + "_p50_ms", decimal(health.stages[i].p50_ms));
    values.emplace_back(name + "_p99_ms", decimal(health.stages[i].p99_ms));
    values.emplace_back(name + "_max_ms", decimal(health.stages[i].max_ms));
  }
  return values;
}

std::string message_of(const ipc::Health& health, DiagnosticLevel level, std::int64_t now_mono_ns) {
  if (level == DiagnosticLevel::stale)
    return "silent for " + decimal(1e-9 * static_cast<double>(now_mono_ns - health.mono_ns)) + " s";
  const std::string_view reason = ipc::text_of(health.reason);
  if (!reason.empty()) return std::string(reason);
  constexpr const char* kWords[] = {"starting", "ok", "degraded", "failed", "stopping"};
  return health.state < std::size(kWords) ? kWords[health.state] : "unknown state";
}

void write_status(CdrWriter& out, const ipc::Health& health, std::int64_t now_mono_ns) {
  const DiagnosticLevel level = level_of(health, now_mono_ns);
  out.number(static_cast<std::uint8_t>(level));
  out.text(ipc::text_of(health.process));
  out.text(message_of(health, level, now_mono_ns));
  out.text("gvom");  // hardware_id
  const Values values = values_of(health);
  out.count(values.size());
  for (const auto& [key, value] : values) {
    out.text(key);
    out.text(value);
  }
}

}  // namespace

DiagnosticLevel level_of(const ipc::Health& health, std::int64_t now_mono_ns) {
  if (now_mono_ns - health.mono_ns > kSilent_ns) return DiagnosticLevel::stale;
  switch (static_cast<ipc::HealthState>(health.state)) {
    case ipc::HealthState::ok:
      return DiagnosticLevel::ok;
    case ipc::HealthState::starting:
    case ipc::HealthState::degraded:
    case ipc::HealthState::stopping:
      return DiagnosticLevel::warn;
    case ipc::HealthState::failed:
      break;
  }
  return DiagnosticLevel::error;
}

void write_diagnostics(std::int64_t stamp_ns, const std::vector<ipc::Health>& processes,
                       std::int64_t now_mono_ns, std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  write_header(out, stamp_ns, "");
  out.count(processes.size());
  for (const ipc::Health& health : processes) write_status(out, health, now_mono_ns);
}

}  // namespace gvom::ros
