// A source without a sensor, for what stands behind sources.
#pragma once

#include "services/ingest/source.hpp"

namespace gvom::test {

/// Sweeps stamped 1, 2, 3 ... ns: a recording of `sweeps`, or a sensor that never ends. Touches what it holds
/// as a decoder does, so that ThreadSanitizer sees anybody else there.
class CountingSource : public ingest::Source {
 public:
  static constexpr std::size_t kReturns = 16;

  CountingSource(bool live, std::int64_t sweeps) : live_(live), sweeps_(sweeps) {}

  tl::expected<ingest::SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds) override {
    out.clear();
    if (!live_ && given_ == sweeps_) {
      warnings_.emplace_back("the end");
      return ingest::SourceEvent::kEnd;
    }
    out.stamp_ns = ++given_;
    out.times_ns.push_back(out.stamp_ns);
    out.returns.resize(kReturns, {5, 0, 0, 0});
    ++counters_.sweeps;
    return ingest::SourceEvent::kSweep;
  }
  tl::expected<void, std::string> rewind() override {
    given_ = 0;
    return {};
  }
  [[nodiscard]] bool is_live() const override { return live_; }
  void set_time_hint(std::int64_t stamp_ns) override { hint_ns_ = stamp_ns; }
  [[nodiscard]] const ingest::SourceCounters& counters() const override { return counters_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  bool live_;
  std::int64_t sweeps_;
  std::int64_t given_ = 0;
  std::int64_t hint_ns_ = 0;
  ingest::SourceCounters counters_;
  std::vector<std::string> warnings_;
};

}  // namespace gvom::test
