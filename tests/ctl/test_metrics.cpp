// Prometheus's format: read by a strict reader of our own, and by promtool where that is installed.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/common/temporary_file.hpp"
#include "tests/ctl/exposition_reader.hpp"
#include "tests/ctl/vehicle_at.hpp"
#include "tools/ctl/exposition.hpp"
#include "tools/ctl/http_server.hpp"
#include "tools/ctl/render.hpp"

using namespace gvom;
using namespace gvom::test;
using ctl::Exposition;

namespace {

/// A snapshot that has a sample of every family.
ctl::Snapshot full_snapshot() {
  VehicleAt vehicle;
  ipc::Health fusion =
      health_of("gvom-fusion", ipc::HealthState::ok, kNow_ns, {{"maps_fused", 12}, {"maps_lost", 1}});
  ipc::set_text(fusion.backend, "cpu");
  ipc::set_text(fusion.backend_details, "an \"odd\" \\ name");
  ipc::set_text(fusion.stages[0].name, "fuse");
  fusion.stages[0] = {{'f', 'u', 's', 'e'}, 1.5, 2.5, 4.0};
  fusion.stage_count = 1;
  vehicle.observed.add(fusion);
  return vehicle.snapshot();
}

}  // namespace

TEST_CASE("every figure is there, in seconds and bytes") {
  auto metrics = read_exposition(to_prometheus(full_snapshot()));
  const auto value = [&](const std::string& name, const std::string& labels) {
    INFO(name << labels);
    REQUIRE(metrics[name].samples.count(labels) == 1);
    return metrics[name].samples[labels];
  };
  CHECK(value("gvom_problems", "") == 0);
  CHECK(value("gvom_up", R"({process="gvom-roudi"})") == 1);
  CHECK(value("gvom_state", R"({process="gvom-fusion",state="ok"})") == 1);
  CHECK(value("gvom_state", R"({process="gvom-fusion",state="hung"})") == 0);
  CHECK(value("gvom_maps_fused_total", R"({process="gvom-fusion"})") == 12);
  CHECK(value("gvom_drops_total", R"({process="gvom-fusion",reason="maps_lost"})") == 1);
  CHECK(value("gvom_drops_total", R"({process="gvom-ingest-rear",reason="overrun"})") == 95);
  CHECK(value("gvom_stage_seconds", R"({process="gvom-fusion",stage="fuse",statistic="p99"})") ==
        Approx(0.0025));
  CHECK(value("gvom_backend_info", R"({process="gvom-fusion",backend="cpu",details="an \"odd\" \\ name"})") ==
        1);
  CHECK(value("gvom_build_info", R"({process="gvom-fusion",version="0.3.0",config="0123456789abcdef"})") ==
        1);
  CHECK(value("gvom_lidar_columns_seen_ratio", R"({lidar="front"})") == 1);
  CHECK(value("gvom_lidar_unknown", R"({lidar="front"})") == 0);
  CHECK(value("gvom_restarts_total", R"({process="gvom-fusion"})") == 2);
  CHECK(value("gvom_health_age_seconds", R"({process="gvom-odometry"})") == Approx(0.5));
  CHECK(value("gvom_data_age_seconds", R"({process="gvom-ingest-front"})") == Approx(0.08));
  CHECK(value("gvom_product_rate_hertz", R"({process="gvom-fusion"})") == 10);
  CHECK(value("gvom_process_memory_bytes", R"({process="gvom-roudi"})") == 50'000'000);
  CHECK(value("gvom_process_cpu_seconds_total", R"({process="gvom-roudi"})") == 1.5);
  CHECK(value("gvom_layers_age_seconds", "") == Approx(0.08));
  CHECK(value("gvom_layers_publish_age_seconds", "") == Approx(0.05));
  CHECK(value("gvom_lidar_missing", R"({lidar="front"})") == 0);
  CHECK(value("gvom_odometry_rate_hertz", "") == Approx(20));
  CHECK(value("gvom_pool_used_chunks", R"({chunk_bytes="2000"})") == 3);
}

TEST_CASE("large counters keep every digit, and text is escaped") {
  Exposition out;
  out.add(Exposition::Type::counter, "a_total", "Help.", {{"b", "x\"\\\ny"}}, 123456789012.0);
  CHECK(out.text() ==
        "# HELP a_total Help.\n# TYPE a_total counter\na_total{b=\"x\\\"\\\\\\ny\"} 123456789012\n");
}

TEST_CASE("families stay whole, however their samples come") {
  Exposition out;
  for (const char* process : {"x", "y"})
    for (const char* name : {"b", "a"}) out.add(Exposition::Type::gauge, name, "Help.", {{"p", process}}, 1);
  CHECK(out.text() ==
        "# HELP b Help.\n# TYPE b gauge\nb{p=\"x\"} 1\nb{p=\"y\"} 1\n"
        "# HELP a Help.\n# TYPE a gauge\na{p=\"x\"} 1\na{p=\"y\"} 1\n");
}

TEST_CASE("the reader refuses what a scraper would") {
  const std::string good = "# HELP a A.\n# TYPE a gauge\na 1\n";
  CHECK_NOTHROW(read_exposition(good));
  for (const char* bad : {"a 1\n", "# HELP a A.\n# TYPE a gauge\na 1", "# HELP a A.\n# TYPE a gauge\na one\n",
                          "# HELP a A.\n# TYPE a counter\na 1\n", "# HELP a A.\n# TYPE a gauge\na{b=c} 1\n",
                          "# HELP a A.\n# TYPE a gauge\na 1\na 2\n", "# HELP a A.\n# TYPE a gauge\nb 1\n"}) {
    INFO(bad);
    CHECK_THROWS(read_exposition(bad));
  }
}

TEST_CASE("promtool finds nothing wrong") {
  if (std::system("command -v promtool > /dev/null") != 0) {
    WARN("SKIPPED: no promtool in PATH (Debian's package prometheus has it)");
    return;
  }
  const TemporaryFile metrics(to_prometheus(full_snapshot()));
  CHECK(std::system(("promtool check metrics < " + metrics.path()).c_str()) == 0);
}

TEST_CASE("an address to listen at is IPv4 and a port") {
  const auto endpoint = ctl::parse_endpoint("127.0.0.1:9464");
  REQUIRE(endpoint);
  CHECK(endpoint->port() == 9464);
  CHECK(endpoint->address().is_loopback());
  for (const char* bad : {"", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", ":9464",
                          "localhost:1", "::1:9464", "1.2.3:4"}) {
    INFO(bad);
    CHECK(!ctl::parse_endpoint(bad));
  }
}
