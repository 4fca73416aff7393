// The times of a sensor whose clock is not that of the vehicle, by when its packets came.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/sweep.hpp"
#include "services/ingest/decoder.hpp"

namespace gvom::ingest {

/// A line through pairs of a packet's stamp and its arrival: the line that lies below all pairs of the last
/// 32 s and closest to them. The network only ever delays, so the pairs that lie on it were delayed least,
/// and its slope is the sensor's rate (R. Moon, Skelly, Towsley 1999: clock skew from network delays). Times
/// within a sweep are moved by the same line, so that deskewing is as exact as the sensor's own rate.
class ArrivalClock {
 public:
  /// A packet whose newest time was `stamp_ns` came at `arrival_ns` (Unix time). The line begins anew if the
  /// sensor's clock does: if stamps go back, or come before they can have been sent, several times running,
  /// or if for two seconds everything is later than before by over half a second (this machine's clock was
  /// set).
  void take(std::int64_t stamp_ns, std::int64_t arrival_ns);

  /// When the packet with that stamp would have come, had it been delayed as little as any.
  [[nodiscard]] std::int64_t arrival_of(std::int64_t stamp_ns) const;

  /// All times of the sweep, to those of arrival.
  void move(Sweep& sweep) const;

  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }

 private:
  static constexpr std::int64_t kBucket_ns = 250'000'000;
  static constexpr std::size_t kBuckets = 128;

  struct Pair {
    std::int64_t stamp_ns = 0;
    std::int64_t delay_ns = 0;  // arrival - stamp
  };

  [[nodiscard]] bool fits(const Pair& pair);
  void begin(const Pair& first);
  void add(const Pair& pair);
  void fit();
  [[nodiscard]] std::int64_t delay_at(std::int64_t stamp_ns) const;
  [[nodiscard]] const Pair& from_oldest(std::size_t i) const { return pairs_[(first_ + i) % kBuckets]; }

  std::array<Pair, kBuckets> pairs_{};  // a ring: the least delayed pair of each bucket of stamps
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::int64_t newest_ns_ = 0;      // stamp
  std::int64_t late_since_ns_ = 0;  // arrival; 0: the newest pair was not late by far
  RestartDetector other_clock_;
  std::uint64_t restarts_ = 0;
  // The line: delay = base + slope * (stamp - at).
  std::int64_t at_ns_ = 0;
  std::int64_t base_ns_ = 0;
  double slope_ = 0;
};

/// Adds to all times of the sweep.
void shift(Sweep& sweep, std::int64_t by_ns);

}  // namespace gvom::ingest
