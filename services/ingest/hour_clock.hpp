// Full times from counters that start again with every hour.
#pragma once

#include <cstdint>
#include <optional>

namespace gvom::ingest {

/// Velodyne sensors count microseconds past the hour. The hour of the first packet is the one that brings it
/// nearest to the capture time (a recording) or to the hint (live); from there on time is continuous.
class HourClock {
 public:
  /// The full time of a packet of `past_hour_ns`. `capture_ns` is 0 live; `received_ns` is 0 in a recording.
  std::int64_t full_time_ns(std::int64_t past_hour_ns, std::int64_t capture_ns, std::int64_t received_ns);

  /// Live: a time near now. Takes the hour anew if this contradicts the one in use.
  void hint(std::int64_t stamp_ns);

  /// True if a live clock has had no hint: its hour is 0.
  [[nodiscard]] bool is_hour_unknown() const { return live_ && !hint_; }

  void reset() { last_.reset(); }

 private:
  struct Moment {
    std::int64_t full_ns;
    std::int64_t reference_ns;
  };
  std::optional<Moment> last_;
  std::optional<std::int64_t> hint_;
  bool live_ = false;
};

}  // namespace gvom::ingest
