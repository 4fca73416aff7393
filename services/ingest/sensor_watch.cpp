#include "services/ingest/sensor_watch.hpp"

#include <cstdio>

#include "services/ingest/loss_words.hpp"

namespace gvom::ingest {

namespace {

constexpr std::int64_t kLook_ns = 100'000'000;
constexpr std::int64_t kSilence_ns = 500'000'000;
constexpr double kFlood = 1.5;           // times the most that the sensor sends
constexpr double kStrayPerSecond = 5;    // a stray packet is no fault
constexpr double kLossPercent = 5;       // of columns
constexpr double kMisplacedPercent = 2;  // of packets

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// " (a VLS-128, model byte 0xA1)", or nothing.
std::array<char, sizeof(KindText) + 4> in_brackets(const KindText& kind) {
  std::array<char, sizeof(KindText) + 4> text{};
  if (kind[0] != '\0') std::snprintf(text.data(), text.size(), " (%s)", kind.data());
  return text;
}

/// The packets of the sensor itself.
std::uint64_t of_sensor(const SourceCounters& counters) {
  return counters.packets - counters.foreign_packets - counters.second_sensor_packets - counters.slow_packets;
}

}  // namespace

SensorWatch::SensorWatch(double most_packets_per_s, const services::LidarConfig& lidar, std::int64_t now_ns)
    : most_packets_per_s_(most_packets_per_s), lidar_(lidar), heard_ns_(now_ns), now_ns_(now_ns) {
  looks_[looked_++].at_ns = now_ns;
}

void SensorWatch::update(const SourceCounters& counters, std::uint64_t overruns, std::int64_t now_ns) {
  const Look& newest = looks_[(looked_ - 1) % kLooks];
  if (most_packets_per_s_ <= 0 || now_ns - newest.at_ns < kLook_ns) return;
  now_ns_ = now_ns;
  if (of_sensor(counters) != of_sensor(newest.counters)) heard_ns_ = now_ns;
  const Look oldest = looked_ < kLooks ? looks_[0] : looks_[looked_ % kLooks];
  const Look now{counters, overruns, now_ns};
  looks_[looked_++ % kLooks] = now;
  judge(oldest, now);
}

void SensorWatch::see(SensorFault fault, double value) {
  seen_.see(fault, value, now_ns_);
}

void SensorWatch::judge(const Look& before, const Look& now) {
  const double per_s = 1e9 / static_cast<double>(now.at_ns - before.at_ns);
  const auto rate = [&](std::uint64_t SourceCounters::*counter) {
    return static_cast<double>(now.counters.*counter - before.counters.*counter) * per_s;
  };
  const std::int64_t silent_ns = now.at_ns - heard_ns_;
  seen_.forget(SensorFault::silence);
  if (silent_ns >= kSilence_ns) see(SensorFault::silence, static_cast<double>(silent_ns) * 1e-9);
  if (const double packets = rate(&SourceCounters::packets); packets > kFlood * most_packets_per_s_)
    see(SensorFault::flood, packets);
  if (const double slow = rate(&SourceCounters::slow_packets); slow > 0) {
    slow_address_ = now.counters.slow_address;
    see(SensorFault::slow, slow);
  }
  if (const double second = rate(&SourceCounters::second_sensor_packets); second > kStrayPerSecond) {
    second_address_ = now.counters.second_address;
    second_kind_ = now.counters.second_kind;
    see(SensorFault::second_sensor, second);
  }
  if (const double lost = rate(&SourceCounters::kernel_drops); lost > 0) see(SensorFault::queue_loss, lost);
  if (const double cut = rate(&SourceCounters::overflow_returns); cut > 0) see(SensorFault::cut, cut);
  const double overruns = static_cast<double>(now.overruns - before.overruns) * per_s;
  if (overruns > 0) see(SensorFault::overrun, overruns);
  judge_foreign(before, now, per_s);
  judge_shares(before.counters, now.counters);
}

void SensorWatch::judge_foreign(const Look& before, const Look& now, double per_s) {
  const auto strange = [](const SourceCounters& counters) {
    return counters.foreign_packets - counters.side_packets;
  };
  const std::uint64_t foreign = strange(now.counters) - strange(before.counters);
  const double rate = static_cast<double>(foreign) * per_s;
  if (foreign > 0 && now.counters.refusal[0] != '\0') {
    refusal_ = now.counters.refusal;
    return see(SensorFault::refused, rate);
  }
  if (rate <= kStrayPerSecond) return;
  const std::uint64_t changes = now.counters.foreign_size_changes - before.counters.foreign_size_changes;
  foreign_size_ = now.counters.foreign_size;
  foreign_kind_ = now.counters.foreign_kind;
  see(changes * 10 > foreign ? SensorFault::garbage : SensorFault::other_model, rate);
}

void SensorWatch::judge_shares(const SourceCounters& before, const SourceCounters& now) {
  const auto more = [&](std::uint64_t SourceCounters::*counter) { return now.*counter - before.*counter; };
  const std::uint64_t dropped = more(&SourceCounters::dropped_sweeps);
  if (dropped > 1 && more(&SourceCounters::sweeps) == 0) {
    see(SensorFault::dropped,
        100 * (now.dropped_fractions - before.dropped_fractions) / static_cast<double>(dropped));
  }
  const std::uint64_t misfits = more(&SourceCounters::misfit_sweeps);
  if (misfits > 1 && more(&SourceCounters::sweeps) == 0)
    see(SensorFault::misfit, static_cast<double>(misfits));
  const std::uint64_t packets = more(&SourceCounters::packets);
  const std::uint64_t columns = more(&SourceCounters::columns);
  const auto judge_share = [this](SensorFault fault, double share, double most) {
    if (share > most) see(fault, share);
  };
  const std::uint64_t missing = more(&SourceCounters::missing_columns);
  judge_share(SensorFault::loss, percent(missing, columns + missing), kLossPercent);
  const std::uint64_t invalid = more(&SourceCounters::invalid_columns);
  judge_share(SensorFault::invalid, percent(invalid, columns + invalid), kLossPercent);
  judge_share(SensorFault::duplicates, percent(more(&SourceCounters::duplicate_packets), packets),
              kMisplacedPercent);
  const std::uint64_t misplaced =
      more(&SourceCounters::out_of_order_packets) + more(&SourceCounters::late_packets);
  judge_share(SensorFault::disorder, percent(misplaced, packets), kMisplacedPercent);
}

void SensorWatch::describe(services::Words& words) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(SensorFault::count); ++i) {
    const auto fault = static_cast<SensorFault>(i);
    if (seen_.has(fault, now_ns_)) tell(fault, seen_.value(fault), words);
  }
}

void SensorWatch::tell(SensorFault fault, double value, services::Words& words) const {
  switch (fault) {
    case SensorFault::silence:
      return words.add("no packets for %.1f s", value);
    case SensorFault::flood:
      return words.add("flood: %.0f packets/s, a sensor sends at most %.0f", value, most_packets_per_s_);
    case SensorFault::slow:
      return words.add("%s sends %.0f packets/s, too few for such a sensor: not used",
                       to_text(slow_address_).data(), value);
    case SensorFault::second_sensor:
      return words.add("packets of a second sensor at %s%s: %.0f/s not used", to_text(second_address_).data(),
                       in_brackets(second_kind_).data(), value);
    case SensorFault::other_model:
      return words.add("packets of another model, %llu bytes each%s: %.0f/s not used",
                       static_cast<unsigned long long>(foreign_size_), in_brackets(foreign_kind_).data(),
                       value);
    case SensorFault::garbage:
      return words.add("garbage: %.0f packets/s not used", value);
    case SensorFault::refused:
      return words.add("%.0f messages/s not used: %s", value, refusal_.data());
    case SensorFault::loss:
      return words.add("%.0f %% of packets lost", value);
    case SensorFault::queue_loss:
      return words.add("%.0f packets/s lost in the socket's queue", value);
    case SensorFault::cut:
      return words.add("the cloud is cut, %.0f returns/s: raise max_returns", value);
    case SensorFault::duplicates:
      return words.add("%.0f %% of packets came again", value);
    case SensorFault::disorder:
      return words.add("%.0f %% of packets out of order", value);
    case SensorFault::invalid:
      return words.add("%.0f %% of columns invalid", value);
    case SensorFault::dropped:
      return tell_dropped(value, lidar_, words);
    case SensorFault::misfit:
      return tell_misfit(lidar_, words);
    case SensorFault::overrun:
      return words.add("%.0f sweeps/s dropped, waiting to be mapped", value);
    case SensorFault::count:
      return;
  }
}

}  // namespace gvom::ingest
