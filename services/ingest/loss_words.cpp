#include "services/ingest/loss_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gvom::ingest {

namespace {

double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

std::string span_text(const TimeSpan& span) {
  return fmt::format("{:.1f} .. {:.1f} s", seconds(span.first_ns), seconds(span.last_ns));
}

/// The key that decides, if there is one.
std::string key_of(SweepLoss why, const services::OdometryConfig& config) {
  if (why == SweepLoss::gap) return fmt::format(" (odometry.max_gap_s is {})", config.max_gap_s);
  if (why == SweepLoss::jump) return fmt::format(" (odometry.max_speed_mps is {})", config.max_speed_mps);
  if (why == SweepLoss::timeout) return fmt::format(" (odometry.timeout_s is {})", config.timeout_s);
  if (why == SweepLoss::clock)
    return fmt::format(" (odometry.max_clock_offset_s is {})", config.max_clock_offset_s);
  return {};
}

/// If no sweep met the odometry, or both would span the same time by other clocks: whose clock it may be, and
/// the keys for that.
std::string guess(const SweepLosses& losses, const TimeSpan& odometry) {
  const SweepLosses::Of& before = losses.of(SweepLoss::before_odometry);
  const SweepLosses::Of& after = losses.of(SweepLoss::after_odometry);
  const SweepLosses::Of& placed = losses.placed();
  if ((before.count == 0) == (after.count == 0)) return {};
  const TimeSpan& lost = before.count != 0 ? before.stamps : after.stamps;
  const TimeSpan all{std::min(lost.first_ns, placed.stamps.first_ns),
                     std::max(lost.last_ns, placed.stamps.last_ns)};
  const std::string words = placed.count == 0 ? guess_clock(lost, odometry) : guess_shift(all, odometry);
  if (placed.count != 0 && words.empty()) return {};
  return (words.empty() ? "" : " (" + words + ")") +
         "; for clocks that differ there are lidars.NAME.clock_offset_s and lidars.NAME.clock: arrival";
}

}  // namespace

const char* words_of(SweepLoss why) {
  switch (why) {
    case SweepLoss::before_odometry:
      return "before the odometry";
    case SweepLoss::after_odometry:
      return "after the odometry";
    case SweepLoss::gap:
      return "in a gap of the odometry";
    case SweepLoss::jump:
      return "across a jump of the odometry";
    case SweepLoss::timeout:
      return "no odometry in time";
    case SweepLoss::clock:
      return "of another clock than the odometry's";
    case SweepLoss::count:
      break;
  }
  return "";
}

std::vector<std::string> explain(const SweepLosses& losses, const OdometryIntake& odometry) {
  const std::string odometry_span =
      odometry.span() ? "odometry spans " + span_text(*odometry.span()) : "no odometry came";
  const std::string clock = odometry.span() ? guess(losses, *odometry.span()) : std::string();
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < static_cast<std::size_t>(SweepLoss::count); ++i) {
    const auto why = static_cast<SweepLoss>(i);
    const SweepLosses::Of& of = losses.of(why);
    if (of.count == 0) continue;
    const bool beyond = why == SweepLoss::before_odometry || why == SweepLoss::after_odometry;
    lines.push_back(fmt::format("{} sweeps not mapped: {}{}: {}, sweeps {}{}", of.count, words_of(why),
                                key_of(why, odometry.config()), odometry_span, span_text(of.stamps),
                                beyond ? clock : ""));
  }
  return lines;
}

void tell_dropped(double percent, const services::LidarConfig& lidar, services::Words& words) {
  words.add("no map: its sweeps have %.0f %% of their columns, lidars.%s.min_sweep_fraction is %g", percent,
            lidar.name.c_str(), lidar.min_sweep_fraction);
}

void tell_misfit(const services::LidarConfig& lidar, services::Words& words) {
  words.add("no map: its sweeps are of another mode or pace than lidars.%s.source says", lidar.name.c_str());
}

std::vector<std::string> explain(const SourceCounters& counters, const services::LidarConfig& lidar) {
  std::vector<std::string> lines;
  const std::uint64_t sweeps = counters.sweeps + counters.dropped_sweeps + counters.misfit_sweeps;
  if (sweeps == 0) {
    lines.push_back(
        fmt::format("no sweep came: {} packets, of which {} are not of such a sensor, {} of another "
                    "such, {} snapped",
                    counters.packets, counters.foreign_packets, counters.second_sensor_packets,
                    counters.truncated_packets));
  }
  if (counters.dropped_sweeps > 0) {
    lines.push_back(
        fmt::format("{} of {} sweeps dropped: they have {:.0f} % of their columns at most, "
                    "lidars.{}.min_sweep_fraction is {}",
                    counters.dropped_sweeps, sweeps, 100 * counters.best_dropped_fraction, lidar.name,
                    lidar.min_sweep_fraction));
  }
  if (counters.misfit_sweeps > 0) {
    lines.push_back(
        fmt::format("{} of {} sweeps dropped: they are of another mode or pace than lidars.{}.source says",
                    counters.misfit_sweeps, sweeps, lidar.name));
  }
  if (counters.overflow_returns > 0) {
    lines.push_back(fmt::format("{} returns left out: lidars.{}.max_returns is {}", counters.overflow_returns,
                                lidar.name, lidar.max_returns));
  }
  return lines;
}

}  // namespace gvom::ingest
