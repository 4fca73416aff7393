// What gvom-summary makes of the messages it hears.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <initializer_list>
#include <string>
#include <utility>

#include "ipc/text.hpp"
#include "tools/summary/report.hpp"

using namespace gvom;
using Catch::Matchers::Contains;
using ipc::HealthState;
using summary::RunRecord;
using summary::Usage;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

ipc::Health health_of(const char* process, HealthState state, const char* reason,
                      std::initializer_list<std::pair<const char*, std::uint64_t>> counters = {}) {
  ipc::Health health{};
  ipc::set_text(health.process, process);
  ipc::set_text(health.reason, reason);
  health.state = static_cast<std::uint32_t>(state);
  health.pid = 7;
  for (const auto& [name, value] : counters) {
    ipc::set_text(health.counters[health.counter_count].name, name);
    health.counters[health.counter_count++].value = value;
  }
  return health;
}

ipc::Layers layers_after(std::int64_t latency_ns, std::int64_t stamp_ns = 0) {
  ipc::Layers layers{};
  layers.header.stamp_ns = stamp_ns;
  layers.mono_received_ns = 5;
  layers.mono_published_ns = 5 + latency_ns;
  return layers;
}

}  // namespace

TEST_CASE("processor time is found behind any process name") {
  const std::string fields = " S 1 2 3 4 5 6 7 8 9 10 120 30 14 15 16";
  CHECK(tools::cpu_ticks_of("42 (gvom-fusion)" + fields) == 150);
  CHECK(tools::cpu_ticks_of("42 (a) b (c d)" + fields) == 150);
  CHECK(!tools::cpu_ticks_of("42 (gvom-fusion) S 1 2"));
  CHECK(!tools::cpu_ticks_of(""));
}

TEST_CASE("memory is read by its whole key") {
  const std::string status = "Name:\tVmHWM\nVmHWM:\t    2048 kB\nRssAnon:\t     3 kB\n";
  CHECK(tools::memory_bytes_of(status, "VmHWM") == 2048u * 1024u);
  CHECK(tools::memory_bytes_of(status, "RssAnon") == 3u * 1024u);
  CHECK(!tools::memory_bytes_of(status, "Rss"));
}

TEST_CASE("this process has used something, one that does not exist nothing") {
  const auto own = tools::read_usage(static_cast<std::uint32_t>(getpid()));
  REQUIRE(own);
  CHECK(own->peak_bytes >= own->private_bytes);
  CHECK(own->private_bytes > 0);
  CHECK(!tools::read_usage(0));
}

TEST_CASE("percentiles of the latency are exact") {
  RunRecord record;
  CHECK(!record.latency());
  for (int ms = 200; ms >= 1; --ms) record.add(layers_after(ms * 1'000'000));
  REQUIRE(record.latency());
  CHECK(record.latency()->p50_ms == Approx(100.0));
  CHECK(record.latency()->p99_ms == Approx(198.0));
  CHECK(record.latency()->max_ms == Approx(200.0));
}

TEST_CASE("the recording's length is that of its layers' stamps") {
  RunRecord record;
  record.add(layers_after(1, 100 * kSecond_ns));
  record.add(layers_after(1, 112 * kSecond_ns));
  CHECK(record.recording_s() == Approx(12.0));
}

TEST_CASE("the share of a core is that of the time between two looks, and an ended process counts") {
  RunRecord record;
  record.add(health_of("gvom-fusion", HealthState::ok, ""), Usage{1.0, 100, 80}, 10 * kSecond_ns);
  record.add(health_of("gvom-fusion", HealthState::ok, ""), Usage{2.0, 120, 60}, 14 * kSecond_ns);
  record.add(health_of("gvom-fusion", HealthState::stopping, ""), std::nullopt, 20 * kSecond_ns);
  const auto& process = record.processes().front();
  CHECK(process.share_of_a_core() == Approx(0.25));
  CHECK(process.usage->cpu_s == Approx(2.0));
  CHECK(process.usage->peak_bytes == 120);
  CHECK(process.usage->private_bytes == 80);
}

TEST_CASE("waiting at the start is no complaint, unless it never ended") {
  RunRecord record;
  const auto starting = health_of("gvom-fusion", HealthState::starting, "no maps yet");
  record.add(starting, std::nullopt, 0);
  CHECK_THAT(summary::report(record), !Contains("starting"));
  for (int second = 2; second <= 5; ++second) record.add(starting, std::nullopt, 0);
  CHECK_THAT(summary::report(record), Contains("gvom-fusion was starting (5 s): no maps yet"));
  record.add(health_of("gvom-fusion", HealthState::ok, ""), std::nullopt, 0);
  CHECK_THAT(summary::report(record), Contains("no process reported trouble"));
  record.add(health_of("gvom-fusion", HealthState::degraded, "old"), std::nullopt, 0);
  record.add(health_of("gvom-fusion", HealthState::degraded, "old"), std::nullopt, 0);
  CHECK_THAT(summary::report(record), Contains("gvom-fusion was degraded (2 s): old"));
}

TEST_CASE("drops are named by reason, and only those that happened") {
  RunRecord record;
  record.add(health_of("gvom-ingest-front", HealthState::ok, "",
                       {{"sweeps_in", 120},
                        {"sweeps_mapped", 117},
                        {"drop_before_odometry", 1},
                        {"drop_overrun", 2},
                        {"drop_no_chunk", 0},
                        {"drop_return_far", 9},
                        {"drop_packet_foreign", 4}}),
             std::nullopt, 0);
  record.add(health_of("gvom-fusion", HealthState::ok, "", {{"maps_in", 117}, {"drop_map_too_old", 3}}),
             std::nullopt, 0);
  const std::string text = summary::report(record);
  CHECK_THAT(text, Contains("3: 1 began before the odometry, 2 overrun\n"));
  CHECK_THAT(text, Contains("9 filtered: 9 too far"));
  CHECK_THAT(text, Contains("also 4 drop_packet_foreign\n"));
  CHECK_THAT(text, Contains("3 dropped: 3 too old"));
  CHECK_THAT(text, !Contains("chunk"));
  CHECK_THAT(summary::to_json(record), Contains("\"drop_no_chunk\": 0"));
}

TEST_CASE("a process that reports nothing is in the table, and a restarted one twice") {
  RunRecord record;
  record.add("gvom-roudi", 3, Usage{0.5, 2'000'000, 1'000'000}, 0);
  record.add("gvom-roudi", 4, Usage{0.25, 2'000'000, 1'000'000}, 0);
  CHECK(record.processes().size() == 2);
  CHECK_THAT(summary::report(record), Contains("gvom-roudi") && Contains("0.50 s") && Contains("0.25 s"));
}
