// Faults that come and go: each is told for a while after it was last seen, so that none flickers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace gvom::ingest {

/// `Fault`: an enum of which `count` is the last. Times are CLOCK_MONOTONIC.
template <class Fault>
class Sightings {
 public:
  static constexpr std::int64_t kHold_ns = 1'000'000'000;

  /// @param value how bad it is, for words
  void see(Fault fault, double value, std::int64_t now_ns, std::int64_t hold_ns = kHold_ns) {
    seen_[index(fault)] = {value, now_ns + hold_ns};
  }
  void forget(Fault fault) { seen_[index(fault)] = {}; }

  [[nodiscard]] bool has(Fault fault, std::int64_t now_ns) const {
    return now_ns < seen_[index(fault)].until_ns;
  }
  [[nodiscard]] double value(Fault fault) const { return seen_[index(fault)].value; }

  /// A bit for each fault that is told at `now_ns`.
  [[nodiscard]] std::uint32_t bits(std::int64_t now_ns) const {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (has(static_cast<Fault>(i), now_ns)) bits |= std::uint32_t{1} << i;
    return bits;
  }

 private:
  struct Seen {
    double value = 0;
    std::int64_t until_ns = 0;
  };
  static constexpr std::size_t index(Fault fault) { return static_cast<std::size_t>(fault); }

  std::array<Seen, static_cast<std::size_t>(Fault::count)> seen_{};
};

}  // namespace gvom::ingest
