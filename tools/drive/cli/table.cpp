#include "tools/drive/cli/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace gvom::driving {
namespace {

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

double highest(const std::vector<double>& values) {
  return quantile(values, 1);
}

/// Sums over drives.
struct Totals {
  explicit Totals(const std::vector<Figures>& all) {
    for (const Figures& figures : all) add(figures);
  }

  void add(const Figures& figures) {
    ++worlds;
    with_way += figures.way_s ? 1 : 0;
    arrived_by_way += figures.way_s && figures.arrived() ? 1 : 0;
    arrived += figures.arrived() ? 1 : 0;
    stuck += figures.is_stuck() ? 1 : 0;
    stops += figures.false_stops;
    if (!figures.mishap.empty()) ++mishaps[figures.mishap];
    top_mps.push_back(figures.top_mps);
    mean_mps.push_back(figures.driven_m / std::max(figures.seconds, 0.1));
    nearest_m.push_back(figures.nearest_m);
    cycle_p50_ms.push_back(figures.cycle_p50_ms);
    cycle_p99_ms.push_back(figures.cycle_p99_ms);
    roll_deg.push_back(figures.roll_rad * 180 / M_PI);
    pitch_deg.push_back(figures.pitch_rad * 180 / M_PI);
    if (!figures.arrived()) return;
    seconds.push_back(figures.seconds);
    if (figures.way_s) times_over.push_back(figures.seconds / *figures.way_s);
  }

  /// "2: person 1, rock 1", or 0.
  [[nodiscard]] std::string hits() const {
    const std::string hit = std::string(words_of(Accident::hit)) + " ";
    int count = 0;
    std::string by;
    for (const auto& [what, times] : mishaps) {
      if (what.compare(0, hit.size(), hit) != 0) continue;
      count += times;
      by += (by.empty() ? ": " : ", ") + what.substr(hit.size()) + " " + std::to_string(times);
    }
    return std::to_string(count) + by;
  }
  [[nodiscard]] int mishaps_of(Accident what) const {
    const auto found = mishaps.find(words_of(what));
    return found == mishaps.end() ? 0 : found->second;
  }
  /// Of all worlds, %.
  [[nodiscard]] std::string share(int count) const {
    return print("%.1f %%", worlds == 0 ? NAN : 100.0 * count / worlds);
  }

  int worlds = 0, with_way = 0, arrived_by_way = 0, arrived = 0, stuck = 0, stops = 0;
  std::map<std::string, int> mishaps;
  std::vector<double> times_over, seconds, mean_mps, top_mps, nearest_m, cycle_p50_ms, cycle_p99_ms, roll_deg,
      pitch_deg;
};

std::string row_of(const std::string& name, const std::vector<std::string>& cells) {
  std::string row = "| " + name + " |";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

}  // namespace

Summary summary_of(const std::vector<Figures>& figures) {
  const Totals all(figures);
  const double arrived = all.with_way == 0 ? NAN : 100.0 * all.arrived_by_way / all.with_way;
  return {{"worlds", print("%d", all.worlds)},
          {"with a way", print("%d", all.with_way)},
          {"of these arrived", print("%d, %.1f %%", all.arrived_by_way, arrived)},
          {"hit", all.hits()},
          {"fell", print("%d", all.mishaps_of(Accident::fell))},
          {"tipped over", print("%d", all.mishaps_of(Accident::tipped))},
          {"high-centred", print("%d", all.mishaps_of(Accident::high_centred))},
          {"left the world", print("%d", all.mishaps_of(Accident::left_world))},
          {"stuck, though there was a way", print("%d", all.stuck)},
          {"false stops", print("%d", all.stops)},
          {"time over the truth planner's: p50, p90, max",
           print("%.2f, %.2f, %.2f", quantile(all.times_over, 0.5), quantile(all.times_over, 0.9),
                 highest(all.times_over))},
          {"speed: mean, top (m/s)", print("%.1f, %.1f", mean(all.mean_mps), highest(all.top_mps))},
          {"nearest to an obstacle: min, p50 (m)",
           print("%.2f, %.2f", quantile(all.nearest_m, 0), quantile(all.nearest_m, 0.5))},
          {"cycle: median p50, worst p99 (ms)",
           print("%.1f, %.1f", quantile(all.cycle_p50_ms, 0.5), highest(all.cycle_p99_ms))}};
}

Summary benchmark_of(const std::vector<Figures>& figures) {
  const Totals all(figures);
  int collisions = 0;
  for (const auto& [what, times] : all.mishaps) collisions += times;
  const int tipped = all.mishaps_of(Accident::tipped);
  const int high = all.mishaps_of(Accident::high_centred);
  return {{"success rate", all.share(all.arrived)},
          {"mean time to goal (s)", print("%.1f", mean(all.seconds))},
          {"tip-over rate", all.share(tipped)},
          {"stuck rate, high-centred or standing", all.share(high + all.worlds - all.arrived - collisions)},
          {"other mishaps", all.share(collisions - tipped - high)},
          {"mean roll, pitch (degrees)", print("%.1f, %.1f", mean(all.roll_deg), mean(all.pitch_deg))}};
}

std::string text_of(const Summary& summary) {
  std::string text;
  for (const auto& [name, value] : summary) text += name + ": " + value + "\n";
  return text;
}

std::string markdown_of(const std::vector<std::pair<std::string, Summary>>& campaigns) {
  if (campaigns.empty()) return {};
  std::vector<std::string> names, rules;
  for (const auto& [name, value] : campaigns.front().second) {
    names.push_back(name);
    rules.emplace_back("---");
  }
  std::string table = row_of("", names) + row_of("---", rules);
  for (const auto& [campaign, summary] : campaigns) {
    std::vector<std::string> values;
    for (const auto& [name, value] : summary) values.push_back(value);
    table += row_of(campaign, values);
  }
  return table;
}

std::string failures_of(const Rows& rows, const std::string& folder) {
  std::vector<Figures> failed;
  for (const Figures& figures : rows.figures)
    if (figures.is_stuck() || !figures.mishap.empty()) failed.push_back(figures);
  std::sort(failed.begin(), failed.end(), [](const Figures& a, const Figures& b) { return a.seed < b.seed; });
  std::string text;
  for (const Figures& figures : failed) {
    const std::string seed = std::to_string(figures.seed);
    text += "seed " + seed + ": " + figures.end + "\n  log: " + folder + "/" + figures.world + "-" + seed +
            ".csv\n  again: gvom-drive " + rows.making.options + " --seeds " + seed +
            " --out again --strip all --mcap\n";
  }
  return text;
}

}  // namespace gvom::driving
