// gvomctl status, top and metrics beside a real graph that replays.
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/ctl/exposition_reader.hpp"
#include "tests/ctl/http_get.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using Catch::Matchers::Contains;
using gvom::ipc::test::eventually;
using gvom::ipc::test::is_asleep;
using namespace std::chrono_literals;

namespace {

using Json = nlohmann::json;

/// A busy machine, too, has layers that are new enough.
const std::vector<std::string> kHalfPace{"--rate", "0.5", "--loop"};

struct Status {
  int code;
  Json json;

  [[nodiscard]] const Json& process(const std::string& name) const {
    for (const Json& process : json["processes"])
      if (process["name"] == name) return process;
    throw std::out_of_range(name);
  }
  [[nodiscard]] bool complains(const std::string& words) const {
    return json["problems"].dump().find(words) != std::string::npos;
  }
};

Status status_of(const Vehicle& vehicle) {
  std::vector<std::string> arguments{"status", "--json"};
  for (const std::string& argument : vehicle.arguments()) arguments.push_back(argument);
  const Ended ended = run("gvomctl", arguments, vehicle.folder);
  INFO(ended.output);
  REQUIRE(ended.output.find('{') != std::string::npos);
  return {ended.code, Json::parse(ended.output.substr(ended.output.find('{')))};
}

/// Asks until `shows` is so: what was just started, stopped or killed takes its time.
template <typename Shows>
Status status_until(const Vehicle& vehicle, Shows shows) {
  Status status = status_of(vehicle);
  const bool shown = eventually([&] { return shows(status) || shows(status = status_of(vehicle)); });
  INFO(status.json.dump(1));
  CHECK(shown);
  return status;
}

bool is_well(const Status& status) {
  return status.code == 0;
}

std::unique_ptr<Program> gvomctl(const Graph& graph, std::vector<std::string> arguments) {
  for (const std::string& argument : graph.vehicle().arguments()) arguments.push_back(argument);
  return std::make_unique<Program>("gvomctl", arguments, graph.vehicle().folder);
}

/// The number behind "http://127.0.0.1:" in what it says.
std::uint16_t port_of(const Program& metrics) {
  const std::string before = "http://127.0.0.1:";
  REQUIRE(metrics.says(before));
  REQUIRE(metrics.says("/metrics"));
  const std::string output = metrics.output();
  return static_cast<std::uint16_t>(std::stoi(output.substr(output.find(before) + before.size())));
}

}  // namespace

TEST_CASE("status: all is well while a replay runs, and a killed ingest is missing") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 4));
  graph.start_readers();
  const auto odometry = graph.replay(kHalfPace);
  Status status = status_until(graph.vehicle(), [](const Status& now) {
    // Rates are those since the last Health, and of the odometry that came during the look.
    return is_well(now) && now.process("gvom-fusion")["rate_hz"] > 1.0 &&
           now.json["odometry"]["rate_hz"] > 1.0;
  });
  CHECK(status.json["ok"] == true);
  CHECK(status.json["problems"].empty());
  CHECK(status.json["broker"] == "up");
  REQUIRE(status.json["processes"].size() == 5);
  for (const Json& process : status.json["processes"]) {
    CHECK(process["state"] == "ok");
    CHECK(process["memory_bytes"] > 0);
    CHECK(process["other_config"] == false);
  }
  CHECK(status.process("gvom-odometry")["version"] == status.json["version"]);
  CHECK(status.process("gvom-roudi")["pid"] == graph.roudi().pid());
  const Json& fusion = status.process("gvom-fusion");
  CHECK(fusion["pid"] == graph.fusion().pid());
  CHECK(fusion["backend"] == "cpu");
  CHECK(fusion["counters"]["layers_out"] > 0);
  CHECK(fusion["data_age_s"].is_number());
  for (const Json& process : status.json["processes"])
    for (const auto& [reason, drop] : process["drops"].items()) {
      CHECK(drop["count"] > 0);
      CHECK(process["counters"].value("drop_" + reason, 0) == drop["count"]);
    }
  CHECK(status.json["layers"]["missing"].empty());
  CHECK(status.json["pools"].size() >= 4);
  for (const Json& pool : status.json["pools"]) {
    CHECK(pool["chunks"] > 0);
    CHECK(pool["used"] <= pool["chunks"]);
  }

  REQUIRE(eventually([&] { return is_asleep(graph.fusion().pid()); }));  // within a publish it holds a lock
  graph.fusion().send(SIGSTOP);
  status = status_until(graph.vehicle(),
                        [](const Status& now) { return now.complains("the newest layers are "); });
  CHECK(status.code == 1);
  CHECK(status.json["layers"]["age_s"].get<double>() > 0.5);
  graph.fusion().send(SIGCONT);
  status_until(graph.vehicle(), is_well);

  Vehicle changed = graph.vehicle();  // as if the file were edited under them
  changed.sets.insert(changed.sets.end(), {"fusion.missing_after_s=0.4", "ipc.max_planners=3"});
  const Status other = status_until(changed, [](const Status& now) {
    return now.complains("gvom-roudi has the pools of another configuration") &&
           now.complains("gvom-fusion runs with another configuration than the file's: gvomctl reload");
  });
  CHECK(other.code == 1);
  CHECK_THAT(other.json["problems"].dump(),
             !Contains("gvom-odometry runs with") && !Contains("gvom-ingest-rear runs with"));

  CHECK(graph.ingest("front").kill_asleep() == 128 + SIGKILL);
  status = status_until(graph.vehicle(), [](const Status& now) {
    return now.process("gvom-ingest-front")["state"] == "missing" &&
           now.process("gvom-ingest-rear")["state"] == "ok";
  });
  CHECK(status.code == 1);
  graph.start_ingest("front");
  status_until(graph.vehicle(), is_well);
  CHECK(odometry->stop() == 0);
  graph.stop();
}

TEST_CASE("status: without a broker it ends with 69 at once, and says so") {
  const TemporaryFolder folder;
  const Ended ended = run("gvomctl", {"status"}, folder.path());
  CHECK(ended.code == 69);
  CHECK_THAT(ended.output, Contains("no broker answers") && Contains("no vehicle file"));
}

TEST_CASE("status: a broker that hangs is told from one that is not there, and hangs nobody") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 1));
  graph.roudi().send(SIGSTOP);
  const Status status = status_of(graph.vehicle());
  CHECK(status.code == 1);
  CHECK(status.json["broker"] == "hung");
  CHECK(status.process("gvom-roudi")["state"] == "hung");
  CHECK(status.process("gvom-fusion")["state"] == "unknown");
  CHECK(status.process("gvom-roudi")["pid"] == graph.roudi().pid());
  graph.roudi().send(SIGCONT);
  status_until(graph.vehicle(), [](const Status& now) { return now.json["broker"] == "up"; });
  graph.stop();
}

TEST_CASE("top: one frame after the other where there is no terminal; lives through a new broker") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 1);
  auto graph = std::make_unique<Graph>(vehicle);
  graph->start_fusion();
  const auto top = gvomctl(*graph, {"top"});
  CHECK(top->says("gvom-fusion             starting"));
  CHECK_THAT(top->output(), !Contains("\033"));
  graph->stop();
  CHECK(top->says("no broker answers"));
  graph = std::make_unique<Graph>(vehicle);
  graph->start_ingest("rear");
  CHECK(top->says("gvom-ingest-rear        starting"));
  CHECK(top->stop(SIGINT) == 0);
  const auto counted = gvomctl(*graph, {"top", "--count", "2"});
  CHECK(counted->wait() == 0);
  const std::string text = counted->output();
  const std::size_t first = text.find("two_lidars: ");
  REQUIRE(first != std::string::npos);
  const std::size_t second = text.find("two_lidars: ", first + 1);
  REQUIRE(second != std::string::npos);
  CHECK(text.find("two_lidars: ", second + 1) == std::string::npos);
  graph->stop();
}

TEST_CASE("metrics: fetched over HTTP while a replay runs, they are Prometheus's and say the same") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 4));
  graph.start_readers();
  const auto odometry = graph.replay(kHalfPace);
  const auto metrics = gvomctl(graph, {"metrics", "--listen", "127.0.0.1:0"});
  const std::uint16_t port = port_of(*metrics);
  std::map<std::string, MetricFamily> families;
  CHECK(eventually([&] {
    const HttpAnswer answer = http_get(port, "/metrics");
    if (answer.status != 200) return false;
    families = read_exposition(answer.body);
    return answer.body.find("gvom_layers_out_total") != std::string::npos &&
           answer.body.find("gvom_problems 0\n") != std::string::npos &&
           families["gvom_maps_fused_total"].samples["{process=\"gvom-fusion\"}"] > 0;
  }));
  for (const char* process :
       {"gvom-roudi", "gvom-odometry", "gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"})
    CHECK(families["gvom_up"].samples[std::string("{process=\"") + process + "\"}"] == 1);
  CHECK(families["gvom_stage_seconds"].samples.size() > 3);
  CHECK(families["gvom_pool_chunks"].samples.size() >= 4);

  CHECK(http_get(port, "/").status == 404);
  CHECK_THAT(talk(port, "POST /metrics HTTP/1.1\r\nHost: x\r\n\r\n"), Contains("405"));
  CHECK(talk(port, "nonsense\r\n\r\n").empty());
  CHECK(talk(port, "GET /metrics HTTP/1.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n").find("gvom_up") ==
        std::string::npos);
  CHECK(http_get(port, "/metrics").status == 200);
  CHECK(metrics->stop() == 0);
  CHECK(odometry->stop() == 0);
  graph.stop();
}

TEST_CASE("metrics: an address that other machines reach, or that is none, is refused") {
  const TemporaryFolder folder;
  const Ended open = run("gvomctl", {"metrics", "--listen", "0.0.0.0:9464"}, folder.path());
  CHECK(open.code == 64);
  CHECK_THAT(open.output, Contains("--remote"));
  CHECK(run("gvomctl", {"metrics", "--listen", "localhost"}, folder.path()).code == 64);
}
