// The first time that the loop falls behind, the reader's queue is used to its end: no page of it may be new
// then.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <thread>

#include "services/ingest/sweep_reader.hpp"

using namespace gvom;
using namespace gvom::ingest;

namespace {

constexpr std::size_t kReturns = 65536;  // 2 MB a sweep, 512 pages

/// A sensor with as many returns as there is room for, 500 times a second.
class DenseSource : public Source {
 public:
  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    out.clear();
    for (std::size_t i = 0; i < kReturns; ++i) out.returns.push_back({1, 2, 3, 0});
    ++counters_.sweeps;
    return SourceEvent::kSweep;
  }
  tl::expected<void, std::string> rewind() override { return {}; }
  [[nodiscard]] bool is_live() const override { return true; }
  void set_time_hint(std::int64_t) override {}
  [[nodiscard]] const SourceCounters& counters() const override { return counters_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  SourceCounters counters_;
  std::vector<std::string> warnings_;
};

long minor_faults() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

}  // namespace

TEST_CASE("a queue that fills for the first time touches no new page") {
  SweepReader reader(std::make_unique<DenseSource>(), kReturns, 4, [] {});
  const long before = minor_faults();
  while (reader.overruns().slow < 3) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(minor_faults() - before < 512);  // the thread's own stack and the like; one slot is 512
}
