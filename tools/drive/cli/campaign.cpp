#include "tools/drive/cli/campaign.hpp"

#include <charconv>
#include <cstdio>
#include <mutex>

#include "tools/drive/cli/log_file.hpp"
#include "tools/drive/cli/table.hpp"
#include "tools/sim/parallel.hpp"

namespace gvom::driving {
namespace {

bool read_seed(std::string_view text, std::uint64_t& seed) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seed);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[320];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

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

std::string story_of(const Row& row) {
  const SessionResult& result = row.result;
  const std::string way =
      result.way ? text("%.1f s for who knows the world", result.way->seconds) : "there is no way";
  return text("%s after %.1f s (%s), %.1f m, up to %.1f m/s, nearest to an obstacle %.2f m, %d stops: %s",
              words_of(result.outcome), result.log.seconds(), way.c_str(), result.log.driven_m,
              result.top_speed_mps, result.log.nearest_m, result.false_stops, result.end.c_str());
}

std::string table_of(const std::vector<Row>& rows) {
  std::vector<Figures> all;
  for (const Row& row : rows) all.push_back(figures_of(row.world, row.seed, row.result));
  return text_of(summary_of(all)) + text_of(benchmark_of(all));
}

tl::expected<std::vector<Row>, std::string> run_campaign(const services::VehicleConfig& config,
                                                         const CampaignOptions& options,
                                                         const std::function<void(const Row&)>& done) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = options.first_seed; seed <= options.last_seed; ++seed)
    if (options.driven.count(seed) == 0) seeds.push_back(seed);
  std::vector<tl::expected<Row, std::string>> rows(seeds.size(), tl::unexpected(std::string()));
  std::mutex mutex;
  sim::parallel_for(static_cast<int>(seeds.size()), options.threads, [&](int i) {
    const std::uint64_t seed = seeds[static_cast<std::size_t>(i)];
    auto& row = rows[static_cast<std::size_t>(i)];
    const auto world = world_of(options, seed);
    if (!world) return static_cast<void>(row = tl::unexpected(world.error()));
    Witness witness(options.keeping, *world, seed, config);
    auto result = run_session(*world, config, session_options(options, seed), witness.onlooker());
    if (!result) return static_cast<void>(row = tl::unexpected(result.error()));
    row = Row{world->name, seed, std::move(*result)};
    if (auto drawn = witness.finish(row->result.outcome, story_of(*row)); !drawn)
      return static_cast<void>(row = tl::unexpected(drawn.error()));
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
