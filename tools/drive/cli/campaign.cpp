#include "tools/drive/cli/campaign.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>

#include "tools/drive/cli/log_file.hpp"
#include "tools/sim/parallel.hpp"

namespace gvom::driving {
namespace {

bool read_seed(std::string_view text, std::uint64_t& seed) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seed);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[320];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

/// Sums over the rows.
struct Totals {
  int worlds = 0, with_way = 0, arrived = 0, stuck = 0, stops = 0;
  std::map<std::string, int> mishaps;
  std::vector<double> time_ratios, speeds_mps, top_speeds_mps, nearest_m, cycle_ms;

  void add(const SessionResult& result) {
    ++worlds;
    with_way += result.way ? 1 : 0;
    stops += result.false_stops;
    const DriveLog& log = result.log;
    if (log.mishap) ++mishaps[words_of(log.mishap->what)];
    if (result.way && (result.outcome == Outcome::gave_up || result.outcome == Outcome::too_slow)) ++stuck;
    top_speeds_mps.push_back(result.top_speed_mps);
    nearest_m.push_back(log.nearest_m);
    cycle_ms.insert(cycle_ms.end(), result.cycle_ms.begin(), result.cycle_ms.end());
    if (result.outcome != Outcome::arrived) return;
    ++arrived;
    speeds_mps.push_back(log.driven_m / log.seconds());
    if (result.way) time_ratios.push_back(log.seconds() / result.way->seconds);
  }
};

}  // namespace

bool read_seeds(const std::string& seeds, CampaignOptions& options) {
  const std::size_t dots = seeds.find("..");
  const std::string_view all = seeds;
  if (!read_seed(all.substr(0, dots), options.first_seed)) return false;
  options.last_seed = options.first_seed;
  return dots == std::string::npos ||
         (read_seed(all.substr(dots + 2), options.last_seed) && options.last_seed >= options.first_seed);
}

tl::expected<CourseWorld, std::string> world_of(const CampaignOptions& options, std::uint64_t seed) {
  if (!options.course.empty()) return make_test_world(options.course);
  if (!options.folder_of_world.empty()) return read_course_world(options.folder_of_world);
  return make_campaign_world(seed, options.length_m);
}

SessionOptions session_options(const CampaignOptions& options, std::uint64_t seed) {
  SessionOptions session;
  session.sensor = options.sensor;
  session.odometry_noise = {options.noise[0], options.noise[1]};
  session.ablation = options.ablation;
  session.seed = seed;
  return session;
}

std::string line_of(const Row& row) {
  const SessionResult& result = row.result;
  const DriveLog& log = result.log;
  const std::string way = result.way ? text("%.1f", result.way->seconds) : "no way";
  return text("%-10s %4llu  %-8s %6.1f s (%s), %5.1f m, up to %.1f m/s, nearest %.2f m, %d stops: %s",
              row.world.c_str(), static_cast<unsigned long long>(row.seed), words_of(result.outcome),
              log.seconds(), way.c_str(), log.driven_m, result.top_speed_mps, log.nearest_m,
              result.false_stops, result.end.c_str());
}

std::string table_of(const std::vector<Row>& rows) {
  Totals all;
  for (const Row& row : rows) all.add(row.result);
  std::string out = text("worlds %d, with a way %d\narrived %d\nstuck though there was a way %d\n",
                         all.worlds, all.with_way, all.arrived, all.stuck);
  int mishaps = 0;
  for (const auto& [what, count] : all.mishaps) {
    out += text("%s %d\n", what.c_str(), count);
    mishaps += count;
  }
  out += text("mishaps %d\nfalse stops %d\n", mishaps, all.stops);
  out += text("time over the truth planner's: p50 %.2f, p90 %.2f, max %.2f\n", quantile(all.time_ratios, 0.5),
              quantile(all.time_ratios, 0.9), quantile(all.time_ratios, 1));
  out += text("mean speed p50 %.2f m/s, top speed p50 %.2f, max %.2f m/s\n", quantile(all.speeds_mps, 0.5),
              quantile(all.top_speeds_mps, 0.5), quantile(all.top_speeds_mps, 1));
  out += text("nearest to an obstacle: min %.2f, p50 %.2f m\n", quantile(all.nearest_m, 0),
              quantile(all.nearest_m, 0.5));
  out += text("planner's cycle: p50 %.1f, p99 %.1f, max %.1f ms\n", quantile(all.cycle_ms, 0.5),
              quantile(all.cycle_ms, 0.99), quantile(all.cycle_ms, 1));
  return out;
}

tl::expected<std::vector<Row>, std::string> run_campaign(const services::VehicleConfig& config,
                                                         const CampaignOptions& options,
                                                         const std::function<void(const Row&)>& done) {
  const int count = static_cast<int>(options.last_seed - options.first_seed) + 1;
  std::vector<tl::expected<Row, std::string>> rows(static_cast<std::size_t>(count),
                                                   tl::unexpected(std::string()));
  std::mutex mutex;
  sim::parallel_for(count, options.threads, [&](int i) {
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
    auto& row = rows[static_cast<std::size_t>(i)];
    const auto world = world_of(options, seed);
    if (!world) return static_cast<void>(row = tl::unexpected(world.error()));
    DriveFile file(options.folder, world->name, seed);
    auto result = run_session(*world, config, session_options(options, seed), file.onlooker());
    if (!result) return static_cast<void>(row = tl::unexpected(result.error()));
    row = Row{world->name, seed, std::move(*result)};
    const std::lock_guard lock(mutex);
    done(*row);
  });
  std::vector<Row> all;
  for (auto& row : rows) {
    if (!row) return tl::unexpected(row.error());
    all.push_back(std::move(*row));
  }
  return all;
}

}  // namespace gvom::driving
