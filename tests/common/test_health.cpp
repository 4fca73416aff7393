// What a health message says of what was recorded.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "services/common/health.hpp"

namespace {

using namespace gvom;
using services::HealthReport;
using services::StageHistogram;

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

TEST_CASE("percentiles are at most an eighth above the truth and never below it") {
  std::mt19937 engine(1);
  std::lognormal_distribution<double> duration(15.0, 2.0);
  StageHistogram histogram;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(static_cast<std::int64_t>(duration(engine)));
    histogram.record_ns(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double fraction : {0.01, 0.5, 0.99, 1.0}) {
    const double truth_ms = static_cast<double>(all[static_cast<std::size_t>(fraction * 1000) - 1]) * 1e-6;
    CHECK(histogram.percentile_ms(fraction) >= truth_ms);
    CHECK(histogram.percentile_ms(fraction) <= truth_ms * 1.125);
  }
  CHECK(histogram.max_ms() == Approx(static_cast<double>(all.back()) * 1e-6));
}

TEST_CASE("a histogram takes every duration") {
  StageHistogram histogram;
  CHECK(histogram.percentile_ms(0.5) == 0.0);
  histogram.record_ns(-5);  // a clock that went back counts as nothing
  CHECK(histogram.percentile_ms(0.5) == 0.0);
  histogram.record_ns(INT64_MAX);
  CHECK(histogram.count() == 2);
  CHECK(histogram.max_ms() == static_cast<double>(INT64_MAX) * 1e-6);
  CHECK(histogram.percentile_ms(1.0) == histogram.max_ms());
}

TEST_CASE("a message is due at once, then each second") {
  HealthReport report("gvom-test", 0xfedc);
  CHECK(report.due(5 * kSecond));
  report.take(5 * kSecond);
  CHECK_FALSE(report.due(6 * kSecond - 1));
  CHECK(report.due(6 * kSecond));
}

TEST_CASE("a message holds counters, stages since the last one, rate and state") {
  HealthReport report("gvom-test", 0xfedc);
  std::uint64_t& sweeps = report.counter("sweeps");
  StageHistogram& mapping = report.stage("mapping");
  report.set_backend("cpu", "as configured");
  report.set_state(ipc::HealthState::degraded, std::string(300, 'x'));
  report.take(10 * kSecond);

  sweeps = 7;
  mapping.record_ns(4'000'000);
  for (int i = 0; i < 20; ++i) report.count_product();
  const ipc::Health& message = report.take(12 * kSecond);
  CHECK(std::string(message.process) == "gvom-test");
  CHECK(std::string(message.version) == "0.3.0");
  CHECK(message.config_hash == 0xfedc);
  CHECK(std::string(message.backend) == "cpu");
  CHECK(std::string(message.backend_details) == "as configured");
  CHECK(message.state == 2);
  CHECK(std::string(message.reason) == std::string(255, 'x'));
  CHECK(message.rate_hz == Approx(10.0));
  REQUIRE(message.counter_count == 1);
  CHECK(std::string(message.counters[0].name) == "sweeps");
  CHECK(message.counters[0].value == 7);
  REQUIRE(message.stage_count == 1);
  CHECK(std::string(message.stages[0].name) == "mapping");
  CHECK(message.stages[0].max_ms == Approx(4.0));
  CHECK(message.stages[0].p50_ms == Approx(4.0));

  report.set_state(ipc::HealthState::ok);
  const ipc::Health& next = report.take(13 * kSecond);
  CHECK(std::string(next.reason).empty());
  CHECK(next.stages[0].max_ms == 0.0);
  CHECK(next.counters[0].value == 7);
  CHECK(next.rate_hz == 0.0);
}

TEST_CASE("more names than a message holds are a defect that shows at start") {
  HealthReport report("gvom-test", 0xfedc);
  for (int i = 0; i < ipc::Health::kMaxCounters; ++i) report.counter("c");
  CHECK_THROWS_AS(report.counter("one too many"), std::length_error);
  for (int i = 0; i < ipc::Health::kMaxStages; ++i) report.stage("s");
  CHECK_THROWS_AS(report.stage("one too many"), std::length_error);
}
