#include "tools/endurance/verdict.hpp"

#include <cmath>
#include <cstdio>

namespace gvom::endurance {

namespace {

using Lines = std::vector<std::string>;

template <typename... Arguments>
std::string text(const char* format, Arguments... arguments) {
  char line[512];
  std::snprintf(line, sizeof line, format, arguments...);
  return line;
}

/// A row; its judgement follows when its samples are enough.
void judge(Judged row, const Series& series, double from_s, Measure measure, std::vector<Judged>& out) {
  const auto growth = growth_of(series, from_s, measure);
  if (!growth) return;
  row.growth = *growth;
  row.leaks = growth->change() > row.bound;
  out.push_back(std::move(row));
}

void append(const Lines& more, Lines& lines) {
  lines.insert(lines.end(), more.begin(), more.end());
}

Lines leaks(const Record& record) {
  Lines lines;
  for (const Judged& judged : judge_growth(record))
    if (judged.leaks)
      lines.push_back(text("leak: %s went from %.0f to %.0f %s, by more than %.0f", judged.what.c_str(),
                           judged.growth.first, judged.growth.last, judged.unit.c_str(), judged.bound));
  return lines;
}

/// Only of those whose memory is locked: others may have to read their code again.
Lines page_faults(const Record& record) {
  Lines lines;
  for (const auto& [process, known] : record.processes())
    for (const Life& life : known.lives) {
      const std::uint64_t more = life.newest.major_faults - life.warm_sample.major_faults;
      if (life.warm && life.newest.locked_bytes > 0 && more > 0)
        lines.push_back(text("%s read %llu pages from disk after the warm-up though its memory is locked",
                             process.c_str(), static_cast<unsigned long long>(more)));
    }
  return lines;
}

Lines rounds(const Run& run) {
  Lines lines = run.rounds->defects();
  const std::uint64_t all = run.rounds->rounds();
  const std::uint64_t clean = run.rounds->clean();
  if (run.rounds->compared() == 0) lines.push_back("no layers of one round could be compared with another's");
  if (!run.faults_made && static_cast<double>(clean) < kLeastClean * static_cast<double>(all)) {
    std::string causes;
    for (const auto& [what, count] : run.rounds->disturbances())
      causes += (causes.empty() ? "" : ", ") + what + " (" + std::to_string(count) + ")";
    lines.push_back(text("only %llu of %llu rounds were clean: %s", static_cast<unsigned long long>(clean),
                         static_cast<unsigned long long>(all), causes.c_str()));
  }
  return lines;
}

Lines faults(const Run& run) {
  Lines lines;
  for (const FaultResult& fault : run.faults)
    if (!fault.in_time)
      lines.push_back(text("%s, at %.0f s: not well again after %.1f s", fault.what.c_str(), fault.at_s,
                           fault.recovered_s));
  for (const auto& [process, count] : run.health->restarts())
    if (!run.faults_made)
      lines.push_back(text("%s began anew %llu times, and no fault was made", process.c_str(),
                           static_cast<unsigned long long>(count)));
  return lines;
}

}  // namespace

std::vector<Judged> judge_growth(const Record& record) {
  std::vector<Judged> all;
  for (const auto& [process, known] : record.processes())
    for (const Life& life : known.lives) {
      const double from_s = life.begin_s + record.warm_up_s();
      const std::string name = process + " (" + std::to_string(life.pid) + "): ";
      const auto steady = [&](const char* what, const char* unit, const Series& series, double bound) {
        judge({name + what, unit, {}, bound, false}, series, from_s, Measure::median, all);
      };
      steady("private memory", "bytes", life.private_bytes, kMostGrowth_bytes);
      steady("descriptors", "descriptors", life.descriptors, 0);
      steady("threads", "threads", life.threads, 0);
    }
  for (const PoolLife& life : record.pools())
    for (std::size_t i = 0; i < life.used.size(); ++i) {
      const std::string name = "pool of " + std::to_string(life.newest[i].chunk_bytes) + " bytes";
      judge({name, "chunks", {}, kMostChunks, false}, life.used[i], life.begin_s + record.warm_up_s(),
            Measure::least, all);
    }
  return all;
}

std::vector<std::string> failures_of(const Run& run) {
  Lines lines;
  if (!run.broken_off.empty()) lines.push_back(run.broken_off);
  append(leaks(*run.record), lines);
  append(page_faults(*run.record), lines);
  for (const std::string& defect : run.ledger->defects()) lines.push_back("lost and not counted: " + defect);
  append(rounds(run), lines);
  append(faults(run), lines);
  return lines;
}

}  // namespace gvom::endurance
