#include "services/ingest/source_check.hpp"

#include <fmt/format.h>

#include <utility>

#include "services/ingest/loss_words.hpp"
#include "services/ingest/source_options.hpp"
#include "services/ingest/udp_ports.hpp"

namespace gvom::ingest {

namespace {

constexpr int kSweeps = 3;  // the first and the last of a recording are seldom whole

double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

std::string words_of(const Sweep& sweep) {
  const TimeSpan span = span_of(sweep);
  return fmt::format("{} returns at {} times, {:.3f} .. {:.3f} s, {:.0f} % of its columns",
                     sweep.returns.size(), sweep.times_ns.size(), seconds(span.first_ns),
                     seconds(span.last_ns), 100 * sweep.columns_seen_fraction);
}

/// Why there is none: what the source itself noticed, then what it counted.
std::string why_no_sweep(const Source& source, const services::LidarConfig& lidar) {
  std::string why;
  for (const std::string& warning : source.warnings()) why += warning + "; ";
  return why + explain(source.counters(), lidar).front();
}

/// Decodes the first sweeps; the fullest is left in `fullest`. How many there were.
tl::expected<int, std::string> decode_some(Source& source, Sweep& fullest) {
  Sweep sweep;
  for (int count = 0; count < kSweeps; ++count) {
    const auto event = source.next(sweep, std::chrono::milliseconds(0));
    if (!event) return tl::unexpected(event.error());
    if (*event != SourceEvent::kSweep) return count;
    const bool fuller = sweep.columns_seen_fraction > fullest.columns_seen_fraction;
    if (count == 0 || fuller) std::swap(sweep, fullest);
  }
  return kSweeps;
}

}  // namespace

tl::expected<CheckedSource, SourceError> check_source(const services::LidarConfig& lidar) {
  // Every sweep is handed out, however little there is of it, and judged here.
  SourceOptions options = source_options(lidar);
  options.min_sweep_fraction = 0;
  auto source = open_source(lidar.source, options);
  if (!source) return tl::unexpected(source.error());
  if (auto lack = lack_of_room(lidar.name, options.max_returns, **source); !lack.empty())
    return tl::unexpected(SourceError(std::move(lack)));
  CheckedSource checked;
  if ((*source)->is_live()) {
    checked.found = live_port(lidar.source) ? "its port can be bound" : "its network is there";
  } else {
    Sweep sweep;
    const auto sweeps = decode_some(**source, sweep);
    if (!sweeps) return tl::unexpected(SourceError(sweeps.error()));
    if (*sweeps == 0) return tl::unexpected(SourceError(why_no_sweep(**source, lidar)));
    if (sweep.columns_seen_fraction < lidar.min_sweep_fraction) {
      return tl::unexpected(SourceError(fmt::format(
          "none of the first {} sweeps would be mapped: they have {:.0f} % of their columns at most, "
          "lidars.{}.min_sweep_fraction is {}",
          *sweeps, 100 * sweep.columns_seen_fraction, lidar.name, lidar.min_sweep_fraction)));
    }
    checked.found = "a sweep of " + words_of(sweep);
  }
  checked.warnings = (*source)->warnings();
  if (const std::uint64_t cut = (*source)->counters().overflow_returns; cut > 0)
    checked.warnings.push_back(
        fmt::format("{} returns left out: lidars.{}.max_returns is {}", cut, lidar.name, lidar.max_returns));
  checked.source = std::move(*source);
  return checked;
}

tl::expected<void, services::ConfigError> check_given(const services::VehicleConfig& config,
                                                      const services::LidarConfig& lidar) {
  if (!lidar.source.empty()) return {};
  return tl::unexpected(services::ConfigError{config.path, "lidars." + lidar.name + ".source",
                                              "is empty; give one in the file or by --set"});
}

}  // namespace gvom::ingest
