#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/endurance/verdict.hpp"

namespace gvom::endurance {

namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.compare(0, 10, "model name") == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json machine() {
  utsname system{};
  ::uname(&system);
  return {{"processor", processor()}, {"cores", ::sysconf(_SC_NPROCESSORS_ONLN)}, {"kernel", system.release}};
}

Json rounds_of(const Run& run) {
  const RoundBook& rounds = *run.rounds;
  return {{"all", rounds.rounds()},
          {"clean", rounds.clean()},
          {"disturbed_by", rounds.disturbances()},
          {"layers_compared", rounds.compared()},
          {"layers_wrong", rounds.wrong()},
          {"windows_known", rounds.keys()},
          {"defects", rounds.defect_count()}};
}

Json growth_of_all(const Record& record) {
  Json all = Json::array();
  for (const Judged& judged : judge_growth(record))
    all.push_back({{"what", judged.what},
                   {"unit", judged.unit},
                   {"first_quarter", judged.growth.first},
                   {"last_quarter", judged.growth.last},
                   {"most", judged.growth.most},
                   {"per_hour", judged.growth.per_hour()},
                   {"most_change", judged.bound},
                   {"ok", !judged.leaks}});
  return all;
}

Json processes_of(const Record& record) {
  Json all = Json::array();
  for (const auto& [process, known] : record.processes()) {
    const Life& life = known.lives.back();
    const ProcessSample& now = life.newest;
    const ProcessSample& warm = life.warm_sample;
    Json row{{"process", process},
             {"starts", known.starts},
             {"private_bytes", now.private_bytes},
             {"descriptors", now.descriptors},
             {"threads", now.threads},
             {"cpu_s", now.cpu_s}};
    if (life.warm)
      row["after_warm_up"] = {{"minor_faults", now.minor_faults - warm.minor_faults},
                              {"major_faults", now.major_faults - warm.major_faults},
                              {"voluntary_switches", now.voluntary_switches - warm.voluntary_switches},
                              {"involuntary_switches", now.involuntary_switches - warm.involuntary_switches}};
    all.push_back(std::move(row));
  }
  return all;
}

Json pools_of(const Record& record) {
  Json all = Json::array();
  if (record.pools().empty()) return all;
  for (const ipc::PoolUse& pool : record.pools().back().newest)
    all.push_back({{"chunk_bytes", pool.chunk_bytes},
                   {"chunks", pool.chunks},
                   {"used", pool.used},
                   {"most_used", pool.chunks - pool.min_free}});
  return all;
}

Json faults_of(const Run& run) {
  Json all = Json::array();
  for (const FaultResult& fault : run.faults)
    all.push_back({{"what", fault.what},
                   {"at_s", fault.at_s},
                   {"well_again_after_s", fault.recovered_s},
                   {"in_time", fault.in_time}});
  return all;
}

Json complaints_of(const HealthWatch& health) {
  Json all = Json::object();
  for (const auto& [what, complaint] : health.complaints())
    all[what] = {{"messages", complaint.messages}, {"newest", complaint.newest}};
  return all;
}

}  // namespace

std::string json_of(const Run& run) {
  const auto failures = failures_of(run);
  const Json growth = growth_of_all(*run.record);
  const Json verdict{
      {"ok", failures.empty()},
      {"failures", failures},
      {"run_as", run.how},
      {"minutes_planned", run.planned_s / 60},
      {"minutes", run.lasted_s / 60},
      {"machine", machine()},
      {"lidars", run.lidars},
      {"faults_made", run.faults_made},
      {"seed", run.seed},
      {"packets_sent", run.packets_sent},
      {"layers", {{"heard", run.layers_heard}, {"missed_by_the_soak", run.layers_missed}}},
      {"voxel_maps_heard", run.voxel_maps_heard},
      {"latency_ms", {{"p50", run.latency_p50_ms}, {"p99", run.latency_p99_ms}, {"max", run.latency_max_ms}}},
      {"rounds", rounds_of(run)},
      {"lost_and_counted", run.health->losses()},
      {"ledger_looks", run.ledger->looks()},
      {"complaints", complaints_of(*run.health)},
      {"restarts", run.health->restarts()},
      {"leaks_judged", !growth.empty()},
      {"warm_up_s", run.record->warm_up_s()},
      {"growth", growth},
      {"processes", processes_of(*run.record)},
      {"pools", pools_of(*run.record)},
      {"faults", faults_of(run)},
  };
  return verdict.dump(2) + "\n";
}

}  // namespace gvom::endurance
