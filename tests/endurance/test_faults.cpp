// Faults: one after the other, each cured, and watched until all is well.
#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "tools/endurance/faults.hpp"

using namespace gvom::endurance;

namespace {

constexpr std::int64_t kStep_ns = 50'000'000;

/// A graph that is well again some time after each cure.
struct Patient {
  Board board;
  double heals_after_s = 1;
  std::int64_t now_ns = 1;
  std::vector<std::string> signals;
  bool modes_well = true;

  std::vector<FaultResult> run(std::uint32_t seed, double for_s) {
    Faults faults(seed, 5, kRecovery_s, {"front", "rear"}, board,
                  {[this](const std::string& process, int signal) {
                     signals.push_back(process + " " + std::to_string(signal));
                     return true;
                   },
                   [this](std::int64_t since_ns) {
                     return static_cast<double>(now_ns - since_ns) * 1e-9 >= heals_after_s;
                   },
                   [](std::int64_t, std::int64_t, const std::string&) {}});
    const auto steps = static_cast<int>(for_s * 1e9 / kStep_ns);
    for (int i = 0; i < steps || faults.is_under_way(); ++i) {
      now_ns += kStep_ns;
      faults.step(now_ns, static_cast<double>(now_ns) * 1e-9, i < steps);
      if (faults.is_under_way()) continue;
      for (const auto& mode : board.modes) modes_well = modes_well && mode == SendMode::well;
    }
    return faults.results();
  }
};

std::vector<std::string> names_of(const std::vector<FaultResult>& results) {
  std::vector<std::string> names;
  for (const FaultResult& result : results) names.push_back(result.what);
  return names;
}

}  // namespace

TEST_CASE("the same seed makes the same faults, another one others; all are cured") {
  Patient a, b, c;
  const auto first = a.run(3, 300);
  CHECK(first.size() > 20);
  CHECK(names_of(first) == names_of(b.run(3, 300)));
  CHECK(names_of(first) != names_of(c.run(4, 300)));
  CHECK(a.modes_well);
  for (const FaultResult& fault : first) {
    CHECK(fault.in_time);
    CHECK(fault.recovered_s == Approx(1).margin(0.1));
  }
}

TEST_CASE("who is stopped is let go on; every kind of fault comes, and all processes are hit") {
  Patient patient;
  const auto names = names_of(patient.run(1, 2000));
  for (const char* const what :
       {"kill -9 of gvom-roudi", "kill -9 of gvom-fusion", "kill -9 of gvom-odometry",
        "kill -9 of gvom-ingest-front", "gvom-fusion stopped for 2 s", "lidar rear silent for 2 s",
        "30 % of the packets of front lost for 2 s", "garbage on the port of rear for 2 s"}) {
    INFO(what);
    CHECK(std::find(names.begin(), names.end(), what) != names.end());
  }
  const auto count = [&](int signal) {
    return std::count_if(patient.signals.begin(), patient.signals.end(), [&](const std::string& sent) {
      return sent.find(" " + std::to_string(signal)) != std::string::npos;
    });
  };
  CHECK(count(SIGSTOP) > 0);
  CHECK(count(SIGSTOP) == count(SIGCONT));
}

TEST_CASE("what takes longer than ten seconds is not in time, and is not waited for without end") {
  Patient slow;
  slow.heals_after_s = 12;
  const auto faults = slow.run(1, 60);
  REQUIRE(!faults.empty());
  for (const FaultResult& fault : faults) CHECK_FALSE(fault.in_time);
  Patient never;
  never.heals_after_s = 1e9;
  const auto results = never.run(1, 30);
  REQUIRE(!results.empty());
  CHECK_FALSE(results.front().in_time);
  CHECK(results.front().recovered_s >= 60);
}
