#include "tools/benchmark/report.hpp"

#include "tools/benchmark/machine.hpp"
#include "tools/benchmark/text.hpp"

namespace gvom::bench {

Setting setting_of(const Recording& recording, const std::string& command) {
  std::size_t returns = 0;
  for (const Sweep& sweep : recording.sweeps) returns += sweep.returns.size();
  return {command, machine(), recording.name, recording.sweeps.size(),
          static_cast<double>(returns) / static_cast<double>(recording.sweeps.size())};
}

void Report::add(const std::string& name, const Samples& samples, const std::string& compared_with) {
  add(name, samples);
  for (const Row& other : rows) {
    if (other.name != compared_with) continue;
    rows.back().ratio = rows.back().p50_ms / other.p50_ms;
    rows.back().compared_with = compared_with;
    return;
  }
}

std::string table(const Report& report) {
  const Setting& setting = report.setting;
  std::string all =
      text("machine    %s, one thread\nrecording  %s\n", setting.machine.c_str(), setting.recording.c_str());
  all += text("           %zu sweeps, each on average %.0f returns and %.2f million voxel passes\n\n",
              setting.sweeps, setting.returns_per_sweep, report.passes_per_sweep * 1e-6);
  all += text("%-36s %9s %9s %6s  %s\n", "", "p50 ms", "p99 ms", "runs", "ratio of medians");
  for (const Row& row : report.rows) {
    all += text("%-36s %9.2f %9.2f %6zu", row.name.c_str(), row.p50_ms, row.p99_ms, row.runs);
    if (row.ratio) all += text("  %.2f x %s", *row.ratio, row.compared_with.c_str());
    all += "\n";
  }
  all += text("\ningest, per voxel pass: %.2f ns\n", report.ns_per_pass);
  return all;
}

nlohmann::ordered_json to_json(const Setting& setting) {
  return {{"command", setting.command},
          {"machine", setting.machine},
          {"recording", setting.recording},
          {"sweeps", setting.sweeps},
          {"returns_per_sweep", setting.returns_per_sweep}};
}

nlohmann::ordered_json to_json(const Report& report) {
  nlohmann::ordered_json json = to_json(report.setting);
  json["passes_per_sweep"] = report.passes_per_sweep;
  json["ns_per_pass"] = report.ns_per_pass;
  for (const Row& row : report.rows) {
    nlohmann::ordered_json item{
        {"name", row.name}, {"p50_ms", row.p50_ms}, {"p99_ms", row.p99_ms}, {"runs", row.runs}};
    if (row.ratio) item.update({{"ratio", *row.ratio}, {"compared_with", row.compared_with}});
    json["rows"].push_back(item);
  }
  return json;
}

}  // namespace gvom::bench
