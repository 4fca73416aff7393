// The verdict: a leak, an uncounted loss, wrong layers each make it bad; a quiet run is well.
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "ipc/text.hpp"
#include "tools/endurance/verdict.hpp"

using namespace gvom;
using namespace gvom::endurance;
using Catch::Matchers::Contains;

namespace {

constexpr char kFusion[] = "gvom-fusion";

/// Ten minutes in which all was well, but for what a test changes.
struct Soaked {
  RoundBook rounds{{1}};
  Ledger ledger;
  HealthWatch health{{kFusion}};
  Record record{60};
  Run run;
  double leak_bytes_per_s = 0;
  std::uint64_t descriptors_at_end = 9;
  std::uint32_t chunks_at_end = 20;
  std::uint64_t major_faults_at_end = 0;
  std::uint64_t checksum_at_end = 1;
  std::uint64_t maps_fused = 50;

  void sample() {
    for (int second = 0; second < 600; ++second) {
      const bool late = second > 300;
      ProcessSample sample{};
      sample.private_bytes = 50'000'000 + static_cast<std::uint64_t>(leak_bytes_per_s * second);
      sample.locked_bytes = 1;
      sample.descriptors = late ? descriptors_at_end : 9;
      sample.major_faults = late ? major_faults_at_end : 0;
      record.add(kFusion, 7, second, sample);
      record.add({{1024, 30, late ? chunks_at_end : 20, 5}}, 6, second);
    }
  }

  void play() {
    for (std::uint64_t round = 1; round <= 10; ++round) {
      LayersNote note{};
      note.epoch = round * 1'000'000'000;
      note.checksum = round < 10 ? 1 : checksum_at_end;
      rounds.begin(note.epoch);
      rounds.add(note);
      rounds.end(note.epoch, static_cast<std::int64_t>(note.epoch) + 900'000'000);
    }
    rounds.settle(100'000'000'000);
  }

  std::string failures() {
    sample();
    play();
    for (int look = 0; look < 3; ++look)
      ledger.look_at_fusion(kFusion,
                            {{"maps_in", 50}, {"maps_fused", maps_fused}, {"layers_out", maps_fused}}, {});
    run.rounds = &rounds;
    run.ledger = &ledger;
    run.health = &health;
    run.record = &record;
    std::string text;
    for (const std::string& failure : failures_of(run)) text += failure + "\n";
    const auto json = nlohmann::json::parse(json_of(run));
    CHECK(json["ok"] == text.empty());
    CHECK(json["leaks_judged"] == true);
    return text;
  }
};

}  // namespace

TEST_CASE("a quiet run is well") {
  Soaked soaked;
  CHECK(soaked.failures() == "");
}

TEST_CASE("a leak of 4 kB a second is a leak after ten minutes; of 1 kB it is within the bound") {
  Soaked soaked;
  soaked.leak_bytes_per_s = 4096;
  CHECK_THAT(soaked.failures(), Contains("leak: gvom-fusion (7): private memory"));
  Soaked slow;
  slow.leak_bytes_per_s = 1024;
  CHECK(slow.failures() == "");
}

TEST_CASE("one more descriptor, or two more chunks, are leaks") {
  Soaked soaked;
  soaked.descriptors_at_end = 10;
  CHECK_THAT(soaked.failures(), Contains("descriptors went from 9 to 10"));
  Soaked one;
  one.chunks_at_end = 21;
  CHECK(one.failures() == "");
  Soaked two;
  two.chunks_at_end = 22;
  CHECK_THAT(two.failures(), Contains("leak: pool of 1024 bytes"));
}

TEST_CASE("a page read from disk by who has locked its memory is said") {
  Soaked soaked;
  soaked.major_faults_at_end = 1;
  CHECK_THAT(soaked.failures(), Contains("read 1 pages from disk"));
}

TEST_CASE("an uncounted loss makes the verdict bad") {
  Soaked soaked;
  soaked.maps_fused = 49;
  CHECK_THAT(soaked.failures(), Contains("lost and not counted: gvom-fusion"));
}

TEST_CASE("other layers from the same maps make the verdict bad") {
  Soaked soaked;
  soaked.checksum_at_end = 2;
  CHECK_THAT(soaked.failures(), Contains("other bytes"));
}

TEST_CASE("losses that were counted make the verdict bad only where they are in too many rounds") {
  Soaked one;
  one.rounds.disturb(2'000'000'000, 2'000'000'001, "drop_overrun");
  CHECK(one.failures() == "");
  Soaked two;
  two.rounds.disturb(2'900'000'000, 3'100'000'000, "drop_overrun");
  CHECK_THAT(two.failures(), Contains("only 8 of 10 rounds were clean: drop_overrun (2)"));
  Soaked faults;
  faults.run.faults_made = true;
  faults.rounds.disturb(2'900'000'000, 3'100'000'000, "a fault made");
  CHECK(faults.failures() == "");
}

TEST_CASE("a fault that is not well again in time makes the verdict bad") {
  Soaked soaked;
  soaked.run.faults_made = true;
  soaked.run.faults.push_back({"kill -9 of gvom-fusion", 30, 1.5, true});
  soaked.run.faults.push_back({"gvom-roudi stopped", 60, 12.5, false});
  CHECK(soaked.failures() == "gvom-roudi stopped, at 60 s: not well again after 12.5 s\n");
}

TEST_CASE("what Health counts as lost disturbs its rounds; a restart without a fault is a failure") {
  Soaked soaked;
  ipc::Health health{};
  ipc::set_text(health.process, kFusion);
  health.state = static_cast<std::uint32_t>(ipc::HealthState::ok);
  health.pid = 7;
  health.mono_ns = 2'100'000'000;
  ipc::set_text(health.counters[0].name, "maps_lost");
  health.counter_count = 1;
  soaked.health.take(health, soaked.rounds);
  health.mono_ns = 2'200'000'000;
  health.counters[0].value = 3;
  soaked.health.take(health, soaked.rounds);
  CHECK(soaked.failures() == "");
  CHECK(soaked.rounds.clean() == 9);
  CHECK(soaked.health.losses().at("gvom-fusion maps_lost") == 3);
  health.pid = 8;
  soaked.health.take(health, soaked.rounds);
  REQUIRE(failures_of(soaked.run).size() == 1);
  CHECK_THAT(failures_of(soaked.run)[0], Contains("gvom-fusion began anew 1 times"));
}
