#include "tools/summary/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace gvom::summary {

namespace {

constexpr double kMegabyte = 1e6;

struct Reason {
  const char* counter;
  const char* words;
};

// Why a whole sweep, and why a map, did not get into the map. What else a process counts as dropped is
// printed under its own name.
constexpr Reason kSweepReasons[] = {
    {"drop_before_odometry", "began before the odometry"},
    {"drop_after_odometry", "after the odometry's end"},
    {"drop_odometry_timeout", "no odometry in time"},
    {"drop_odometry_full", "no room to wait for odometry"},
    {"drop_clock_offset", "of another clock than the odometry's"},
    {"drop_odometry_gap", "in a gap of the odometry"},
    {"drop_odometry_jump", "across a jump of the odometry"},
    {"drop_sweep_incomplete", "incomplete"},
    {"drop_sweep_misfit", "of another mode or pace"},
    {"drop_sweep_withheld", "of a sender on trial"},
    {"drop_overrun", "overrun"},
    {"drop_no_chunk", "no free chunk"},
};
constexpr Reason kReturnReasons[] = {
    {"drop_return_not_finite", "not finite"}, {"drop_return_near", "too near"},
    {"drop_return_far", "too far"},           {"drop_return_body", "own body"},
    {"drop_return_overflow", "overflow"},
};
constexpr Reason kMapReasons[] = {
    {"maps_lost", "lost"},
    {"drop_map_too_old", "too old"},
    {"drop_map_duplicate", "duplicate"},
    {"drop_map_wrong_grid", "wrong grid"},
    {"drop_map_old_epoch", "of an old epoch"},
    {"drop_map_refused", "refused"},
    {"drop_map_bad_directory", "with a broken directory"},
    {"drop_map_bad_lookup", "with broken lookup values"},
    {"drop_map_bad_columns", "with broken columns"},
    {"drop_map_bad_lowest_rays", "with broken lowest rays"},
    {"drop_map_bad_records", "with broken records"},
};

struct Sum {
  std::uint64_t total = 0;
  std::string words;  // "3 too old, 1 lost": non-zero ones only
};

template <std::size_t N>
Sum sum_of(const ProcessRecord& process, const Reason (&reasons)[N]) {
  Sum sum;
  for (const Reason& reason : reasons) {
    const std::uint64_t count = process.counter(reason.counter);
    if (count == 0) continue;
    sum.total += count;
    sum.words += fmt::format("{}{} {}", sum.words.empty() ? "" : ", ", count, reason.words);
  }
  return sum;
}

template <std::size_t N>
bool is_one_of(const std::string& counter, const Reason (&reasons)[N]) {
  return std::any_of(std::begin(reasons), std::end(reasons),
                     [&](const Reason& reason) { return counter == reason.counter; });
}

/// Drops that no other line names.
std::string other_drops(const ProcessRecord& process) {
  std::string words;
  for (const auto& [name, count] : process.counters) {
    if (!tools::is_drop(name) || count == 0 || is_one_of(name, kSweepReasons) ||
        is_one_of(name, kReturnReasons) || is_one_of(name, kMapReasons))
      continue;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, name);
  }
  return words;
}

std::string lidar_table(const RunRecord& record) {
  std::string text = fmt::format("{:<16}{:>10}{:>11}{:>8}{:>11}{:>9}\n", "lidar", "packets", "sweeps in",
                                 "mapped", "incomplete", "dropped");
  for (const ProcessRecord* ingest : record.ingests()) {
    const Sum sweeps = sum_of(*ingest, kSweepReasons);
    text += fmt::format("{:<16}{:>10}{:>11}{:>8}{:>11}{:>9}{}{}\n", tools::lidar_of(ingest->name),
                        ingest->counter("packets"), ingest->counter("sweeps_in"),
                        ingest->counter("sweeps_mapped"), ingest->counter("sweep_incomplete"), sweeps.total,
                        sweeps.total > 0 ? ": " : "", sweeps.words);
  }
  for (const ProcessRecord* ingest : record.ingests()) {
    const Sum returns = sum_of(*ingest, kReturnReasons);
    text += fmt::format("  {}: {} returns mapped, {} filtered{}{}\n", tools::lidar_of(ingest->name),
                        ingest->counter("returns_used"), returns.total, returns.total > 0 ? ": " : "",
                        returns.words);
    if (const std::string others = other_drops(*ingest); !others.empty())
      text += fmt::format("  {}: also {}\n", tools::lidar_of(ingest->name), others);
  }
  return text;
}

std::string fusion_lines(const RunRecord& record) {
  std::string text;
  for (const ProcessRecord* fusion : record.fusions()) {
    const Sum maps = sum_of(*fusion, kMapReasons);
    text += fmt::format("fusion ({}): {} maps in, {} fused, {} dropped{}{}; {} layers published\n",
                        fusion->backend, fusion->counter("maps_in"), fusion->counter("maps_fused"),
                        maps.total, maps.total > 0 ? ": " : "", maps.words, fusion->counter("layers_out"));
    if (!fusion->backend_details.empty())
      text += fmt::format("  {}: {}\n", fusion->backend, fusion->backend_details);
    if (const std::string others = other_drops(*fusion); !others.empty())
      text += fmt::format("  also {}\n", others);
  }
  text += fmt::format("layers read here: {}, lost {}\n", record.layers_read(), record.layers_lost());
  if (const auto latency = record.latency())
    text +=
        fmt::format("from a sweep's last packet to its layers: p50 {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms\n",
                    latency->p50_ms, latency->p99_ms, latency->max_ms);
  return text;
}

std::string process_table(const RunRecord& record) {
  std::string text = fmt::format("{:<24}{:>8}{:>11}{:>16}{:>13}\n", "process", "CPU", "of a core",
                                 "peak memory", "not shared");
  std::vector<ProcessRecord> processes = record.processes();
  std::stable_sort(processes.begin(), processes.end(),
                   [](const auto& a, const auto& b) { return a.name < b.name; });
  for (const ProcessRecord& process : processes) {
    if (!process.usage) {
      text += fmt::format("{:<24} ended before it was looked at\n", process.name);
      continue;
    }
    text += fmt::format("{:<24}{:>6.2f} s{:>9.1f} %{:>13.0f} MB{:>10.0f} MB\n", process.name,
                        process.usage->cpu_s, 100.0 * process.share_of_a_core(),
                        static_cast<double>(process.usage->peak_bytes) / kMegabyte,
                        static_cast<double>(process.usage->private_bytes) / kMegabyte);
  }
  return text +
         "  (CPU since the process began, memory made ready included; of a core while this listened;\n"
         "  peak memory counts the shared memory that a process has touched, so it does not add up)\n";
}

/// Who starts waits for the others: only a long wait is worth a line.
bool is_worth_a_line(const Complaint& complaint) {
  constexpr std::uint64_t kLongStart = 3;
  return complaint.state != ipc::HealthState::starting || complaint.messages >= kLongStart;
}

std::string complaints(const RunRecord& record) {
  std::string text;
  for (const ProcessRecord& process : record.processes())
    for (const Complaint& complaint : process.complaints)
      if (is_worth_a_line(complaint))
        text += fmt::format("  {} was {} ({} s): {}\n", process.name, tools::to_string(complaint.state),
                            complaint.messages, complaint.reason);
  return text.empty() ? "no process reported trouble once it had started\n" : "not ok at some time:\n" + text;
}

nlohmann::json json_of(const ProcessRecord& process) {
  nlohmann::json json = {{"name", process.name},
                         {"pid", process.pid},
                         {"backend", process.backend},
                         {"backend_details", process.backend_details}};
  for (const auto& [name, value] : process.counters) json["counters"][name] = value;
  for (const Complaint& complaint : process.complaints)
    json["not_ok"].push_back({{"state", tools::to_string(complaint.state)},
                              {"reason", complaint.reason},
                              {"messages", complaint.messages}});
  if (!process.usage) return json;
  json["cpu_s"] = process.usage->cpu_s;
  json["share_of_a_core"] = process.share_of_a_core();
  json["peak_bytes"] = process.usage->peak_bytes;
  json["private_bytes"] = process.usage->private_bytes;
  return json;
}

}  // namespace

std::string progress_line(const RunRecord& record) {
  std::string text = fmt::format("{:6.1f} s", record.recording_s());
  for (const ProcessRecord* ingest : record.ingests())
    text += fmt::format("   {} {} sweeps", tools::lidar_of(ingest->name), ingest->counter("sweeps_mapped"));
  text += fmt::format("   {} layers", record.layers_read());
  if (const auto latency = record.latency()) text += fmt::format(", p50 {:.1f} ms", latency->p50_ms);
  return text;
}

std::string report(const RunRecord& record) {
  return lidar_table(record) + "\n" + fusion_lines(record) + "\n" + process_table(record) + "\n" +
         complaints(record);
}

std::string to_json(const RunRecord& record) {
  nlohmann::json json = {{"layers_read", record.layers_read()},
                         {"layers_lost", record.layers_lost()},
                         {"recording_s", record.recording_s()}};
  if (const auto latency = record.latency())
    json["latency_ms"] = {{"p50", latency->p50_ms}, {"p99", latency->p99_ms}, {"max", latency->max_ms}};
  for (const ProcessRecord& process : record.processes()) json["processes"].push_back(json_of(process));
  return json.dump(2) + "\n";
}

}  // namespace gvom::summary
