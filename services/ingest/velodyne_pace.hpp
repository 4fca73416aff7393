// How often packets come, by their own stamps.
#pragma once

#include <cstdint>

namespace gvom::ingest {

/// A model and a return mode have one pace. Where a model byte was taken on trust, or the returns were given
/// by hand, another pace proves that wrong. Lost packets and a few that are out of order do not.
class VelodynePace {
 public:
  /// `step_ns` from one packet to the next in time, `expected_us` as the model says.
  void see(std::int64_t step_ns, double expected_us) {
    const double ratio = static_cast<double>(step_ns) * 1e-3 / expected_us;
    short_ += ratio < 1 / kMostOff ? 1 : 0;
    long_ += ratio > kMostOff ? 1 : 0;
    seen_us_ = static_cast<double>(step_ns) * 1e-3;
    if (++count_ < kSteps) return;
    off_ = short_ >= kSteps * 3 / 4 || long_ == kSteps;
    count_ = short_ = long_ = 0;
  }

  /// True if the newest sixteen steps were those of another model or return mode.
  [[nodiscard]] bool is_off() const { return off_; }
  /// The newest step.
  [[nodiscard]] double seen_us() const { return seen_us_; }

 private:
  static constexpr int kSteps = 16;
  static constexpr double kMostOff = 1.4;  // VLS-128: firmware differs by 8 %; models by 2 and more
  int count_ = 0, short_ = 0, long_ = 0;
  double seen_us_ = 0;
  bool off_ = false;
};

}  // namespace gvom::ingest
