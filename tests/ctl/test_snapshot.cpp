// What gvomctl makes of what it hears.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/ctl/vehicle_at.hpp"
#include "tools/ctl/render.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Matchers::Contains;
using ctl::ProcessState;
using ipc::HealthState;

TEST_CASE("a vehicle at which all is well has no problem, and every process is in its place") {
  const ctl::Snapshot snapshot = VehicleAt().snapshot();
  CHECK(snapshot.problems == std::vector<std::string>{});
  REQUIRE(snapshot.processes.size() == 5);
  CHECK(snapshot.processes[0].name == "gvom-roudi");
  CHECK(snapshot.processes[1].name == "gvom-odometry");
  CHECK(snapshot.processes[4].name == "gvom-ingest-rear");
  for (const auto& view : snapshot.processes) CHECK(view.state == ProcessState::ok);
}

TEST_CASE("ages are those of the last Health, and of the packets in the layers") {
  VehicleAt vehicle;
  ipc::Layers layers = layers_at(kNow_ns - 50'000'000);
  layers.lidars[1].newest_stamp_ns -= kSecond_ns / 4;
  vehicle.observed.add(layers);
  const ctl::Snapshot snapshot = vehicle.snapshot();
  CHECK(process(snapshot, "gvom-fusion").health_age_s == Approx(0.5));
  CHECK(process(snapshot, "gvom-fusion").data_age_s == Approx(0.08));
  CHECK(process(snapshot, "gvom-ingest-front").data_age_s == Approx(0.08));
  CHECK(process(snapshot, "gvom-ingest-rear").data_age_s == Approx(0.33));
  CHECK(!process(snapshot, "gvom-odometry").data_age_s);
  CHECK(snapshot.layers->age_s == Approx(0.08));
  CHECK(snapshot.layers->publish_age_s == Approx(0.05));
  CHECK(snapshot.odometry->age_s == Approx(0.0));
  CHECK(snapshot.odometry->rate_hz == Approx(20.0));
}

TEST_CASE("drops are those that are not 0, with their rate between two Healths of one process") {
  VehicleAt vehicle;
  auto drops = process(vehicle.snapshot(), "gvom-fusion").drops;
  REQUIRE(drops.size() == 1);
  CHECK(drops[0].reason == "overrun");
  CHECK(drops[0].count == 95);
  CHECK(drops[0].per_s == Approx(10.0));

  ipc::Health restarted = health_of("gvom-fusion", HealthState::ok, kNow_ns, {{"drop_overrun", 5}});
  restarted.pid = kPid + 1;
  vehicle.observed.add(restarted);
  drops = process(vehicle.snapshot(), "gvom-fusion").drops;
  REQUIRE(drops.size() == 1);
  CHECK(drops[0].count == 5);
  CHECK(!drops[0].per_s);
}

TEST_CASE("a process's own trouble is told in its words") {
  VehicleAt vehicle;
  ipc::Health health = health_of("gvom-ingest-rear", HealthState::degraded, kNow_ns);
  ipc::set_text(health.reason, "no sweeps");
  vehicle.observed.add(health);
  CHECK(vehicle.snapshot().problems == std::vector<std::string>{"gvom-ingest-rear is degraded: no sweeps"});
}

TEST_CASE("a process is missing if it was never heard or has ended, and silent if it is there") {
  VehicleAt vehicle;
  vehicle.expected.processes.emplace_back("gvom-ingest-left");
  CHECK(vehicle.snapshot().problems ==
        std::vector<std::string>{"gvom-ingest-left is missing: nothing was heard of it"});
  CHECK(!process(vehicle.snapshot(), "gvom-ingest-left").pid);

  ipc::Health old = health_of("gvom-ingest-left", HealthState::ok, kNow_ns - 4 * kSecond_ns);
  old.pid = 99;
  vehicle.observed.add(old);
  CHECK(process(vehicle.snapshot(), "gvom-ingest-left").state == ProcessState::silent);
  vehicle.ended_pid = 99;
  CHECK(process(vehicle.snapshot(), "gvom-ingest-left").state == ProcessState::missing);
  CHECK_THAT(process(vehicle.snapshot(), "gvom-ingest-left").reason, Contains("process 99 has ended"));
}

TEST_CASE("who is not expected is shown, unless it has ended well") {
  VehicleAt vehicle;
  vehicle.observed.add(health_of("gvom-other", HealthState::ok, kNow_ns));
  CHECK(vehicle.snapshot().processes.size() == 6);
  vehicle.observed.add(health_of("gvom-other", HealthState::stopping, kNow_ns));
  vehicle.ended_pid = kPid;
  CHECK(vehicle.snapshot().processes.size() == 5);
}

TEST_CASE("old layers, missing lidars, old odometry and an empty pool are problems") {
  VehicleAt vehicle;
  ipc::Layers layers = layers_at(kNow_ns - 2 * kSecond_ns);
  layers.lidars[0].missing = 1;
  vehicle.observed.add(layers);
  vehicle.observed.add(std::vector<ipc::PoolUse>{{1000, 100, 100, 0}});
  ipc::MessageHeader odometry{};
  odometry.sequence = 1;
  vehicle.observed.add(odometry, kNow_ns - 5 * kSecond_ns);
  CHECK(vehicle.snapshot().problems ==
        std::vector<std::string>{"the newest layers are 2.0 s old", "lidar front is missing in the layers",
                                 "the newest odometry is 5.0 s old",
                                 "the pool of 100 chunks of 1000 bytes is empty"});
}

TEST_CASE("who runs another configuration than the file's, or another gvom, is a problem") {
  VehicleAt vehicle;
  ipc::Health fusion = health_of("gvom-fusion", HealthState::ok, kNow_ns);
  ++fusion.config_hash;
  vehicle.observed.add(fusion);
  ipc::Health front = health_of("gvom-ingest-front", HealthState::ok, kNow_ns);
  ipc::set_text(front.version, "0.2.9");
  vehicle.observed.add(front);
  const ctl::Snapshot snapshot = vehicle.snapshot();
  CHECK(
      snapshot.problems ==
      std::vector<std::string>{"gvom-fusion runs with another configuration than the file's: gvomctl reload",
                               "gvom-ingest-front is of gvom 0.2.9, this is 0.3.0: restart it"});
  CHECK_THAT(to_table(snapshot), Contains("    runs gvom 0.3.0, configuration 0123456789abcdf0\n") &&
                                     Contains("\ngvom 0.3.0, configuration 0123456789abcdef\n"));
  const auto json = nlohmann::json::parse(to_json(snapshot));
  CHECK(json["version"] == "0.3.0");
  CHECK(json["config_hash"] == "0123456789abcdef");
  CHECK(json["processes"][2]["config_hash"] == "0123456789abcdf0");
  CHECK(json["processes"][2]["other_config"] == true);
  CHECK(json["processes"][3]["version"] == "0.2.9");
  CHECK(json["processes"][3]["other_version"] == true);
  CHECK(json["processes"][1]["other_config"] == false);
  CHECK(json["processes"][0]["version"].is_null());

  vehicle.expected.config_hash.reset();  // no file: nothing to compare with
  CHECK(vehicle.snapshot().problems.size() == 1);
  vehicle.ended_pid = kPid;  // who has ended runs nothing
  for (const std::string& problem : vehicle.snapshot().problems) CHECK_THAT(problem, Contains("is missing"));
}

TEST_CASE("a broker with other pools than the file's is a problem") {
  VehicleAt vehicle;
  vehicle.expected.pools = {{1000, 100}, {2000, 10}};
  CHECK(vehicle.snapshot().problems.empty());
  vehicle.expected.pools[1].chunks = 11;
  CHECK(vehicle.snapshot().problems ==
        std::vector<std::string>{
            "gvom-roudi has the pools of another configuration than the file's: restart it"});
  vehicle.expected.pools.clear();
  CHECK(vehicle.snapshot().problems.empty());
}

TEST_CASE("a message that was not read is a problem: somebody is of another gvom") {
  VehicleAt vehicle;
  const std::string why = "health: message of gvom 0.2 (version 2) refused, this is 0.3.0 (version 3)";
  for (int i = 0; i < 2; ++i) vehicle.observed.add_refusal(why);
  CHECK(vehicle.snapshot().problems == std::vector<std::string>{why});
}

TEST_CASE("a lidar that fusion does not know, and one whose newest sweep has gaps, are problems") {
  VehicleAt vehicle;
  ipc::Layers layers = layers_at(kNow_ns);
  layers.lidars[0].columns_seen_fraction = 0.6F;
  layers.lidars[1].columns_seen_fraction = 0.97F;
  layers.lidar_count = 3;
  ipc::set_text(layers.lidars[2].name, "left");
  layers.lidars[2].missing = layers.lidars[2].unknown = 1;
  vehicle.observed.add(layers);
  const ctl::Snapshot snapshot = vehicle.snapshot();
  CHECK(snapshot.problems ==
        std::vector<std::string>{"lidar front's newest sweep has 60 % of its columns",
                                 "lidar left is not in gvom-fusion's configuration: its maps are not taken"});
  CHECK_THAT(to_table(snapshot), Contains("    the newest sweep of rear has 97.0 % of its columns\n"));
  const auto json = nlohmann::json::parse(to_json(snapshot));
  CHECK(json["layers"]["lidars"]["front"]["columns_seen_fraction"].get<double>() == Approx(0.6));
  CHECK(json["layers"]["lidars"]["left"]["unknown"] == true);
}

TEST_CASE("layers published a moment ago of old packets, or of packets from nowhere, are old") {
  VehicleAt vehicle;
  const auto problem_with = [&](std::int64_t received_ns, std::int64_t suspended_ns) {
    ipc::Layers layers = layers_at(kNow_ns);
    layers.mono_received_ns = received_ns;
    layers.suspended_ns = suspended_ns;
    vehicle.observed.add(layers);
    const ctl::Snapshot snapshot = vehicle.snapshot();
    return snapshot.problems.empty() ? "" : snapshot.problems.front();
  };
  CHECK(problem_with(kNow_ns - 500'000'000, 0).empty());
  CHECK(problem_with(kNow_ns - 2'059'000'000, 0) == "the newest layers are 2.1 s old");
  CHECK_THAT(problem_with(0, 0), Contains("the newest layers are of unknown age"));
  CHECK_THAT(problem_with(kNow_ns + 1, 0), Contains("the newest layers are of unknown age"));
  const auto json = nlohmann::json::parse(to_json(vehicle.snapshot()));
  CHECK(json["layers"]["age_s"].is_null());
  CHECK(json["layers"]["publish_age_s"] == 0.0);
}

TEST_CASE("a broker that is absent, hung or does not let us in is the only problem: the rest is unknown") {
  VehicleAt vehicle;
  vehicle.observed = {};
  const auto only_problem = [&] {
    const ctl::Snapshot snapshot = vehicle.snapshot();
    CHECK(process(snapshot, "gvom-fusion").state == ProcessState::unknown);
    REQUIRE(snapshot.problems.size() == 1);
    return snapshot.problems.front();
  };
  vehicle.broker = {ctl::BrokerState::absent, false, std::nullopt, "no broker answers"};
  CHECK(only_problem() == "gvom-roudi is missing: no broker answers");
  vehicle.broker.state = ctl::BrokerState::hung;
  CHECK_THAT(only_problem(), Contains("gvom-roudi is hung"));
  vehicle.broker = {ctl::BrokerState::up, false, 3, "run it in the broker's group"};
  CHECK(only_problem() == "the bus cannot be joined: run it in the broker's group");
}

TEST_CASE("a process that was heard before the bus fell silent is unknown, unless it has ended") {
  VehicleAt vehicle;
  vehicle.expected.processes = {"gvom-late"};
  vehicle.observed = {};
  vehicle.observed.add(health_of("gvom-late", HealthState::ok, kNow_ns - 5 * kSecond_ns));
  vehicle.broker.state = ctl::BrokerState::hung;
  CHECK(process(vehicle.snapshot(), "gvom-late").state == ProcessState::unknown);
  vehicle.ended_pid = kPid;
  CHECK(process(vehicle.snapshot(), "gvom-late").state == ProcessState::missing);
}

TEST_CASE("a look is complete when everything was heard twice") {
  const VehicleAt vehicle;
  CHECK(ctl::is_complete(vehicle.observed, vehicle.expected));
  CHECK(!ctl::is_complete(vehicle.observed, {}));  // who knows what else will be heard
  ctl::Expected more = vehicle.expected;
  more.processes.emplace_back("gvom-ingest-left");
  CHECK(!ctl::is_complete(vehicle.observed, more));
}

TEST_CASE("an odometry that begins anew has a rate of its own") {
  ctl::Observed observed;
  ipc::MessageHeader odometry{};
  for (int i = 0; i <= 100; ++i) {
    odometry.sequence = 1000 + static_cast<std::uint64_t>(i);
    observed.add(odometry, i * kSecond_ns / 50);
  }
  CHECK(observed.odometry()->rate_hz == Approx(50.0));
  odometry.sequence = 1;
  observed.add(odometry, 3 * kSecond_ns);
  CHECK(!observed.odometry()->rate_hz);
}

TEST_CASE("two lidars that see the ground at different heights or angles are a problem") {
  VehicleAt vehicle;
  const auto problems = [&](float height_m, float slope_x) {
    vehicle.observed.add(ground_of("gvom-ingest-front", ipc::GroundVerdict::well, -0.12f, -0.03f));
    vehicle.observed.add(ground_of("gvom-ingest-rear", ipc::GroundVerdict::well, height_m, slope_x));
    return vehicle.snapshot().problems;
  };
  CHECK(problems(0.05f, 0.01f).empty());
  CHECK(problems(0.15f, -0.03f) ==
        std::vector<std::string>{
            "front and rear see the ground 0.3 m and 0 degrees apart: is a T_base_sensor wrong?"});
  CHECK(problems(-0.12f, 0.06f) ==
        std::vector<std::string>{
            "front and rear see the ground 0.0 m and 5 degrees apart: is a T_base_sensor wrong?"});
}

TEST_CASE("a file that does not load is the first problem, and what runs is looked at all the same") {
  VehicleAt vehicle;
  vehicle.expected = {"", {"gvom-fusion"}, kVersion};
  vehicle.expected.config_error = "v.yaml:3: map.size: no such key";
  const ctl::Snapshot snapshot = vehicle.snapshot();
  CHECK(snapshot.problems ==
        std::vector<std::string>{"the vehicle's file does not load, who is started anew will "
                                 "not run: v.yaml:3: map.size: no such key"});
  CHECK_THAT(to_table(snapshot), Catch::StartsWith("the vehicle's file does not load: 1 problem\n"));
  CHECK(process(snapshot, "gvom-ingest-rear").state == ctl::ProcessState::ok);
  CHECK(nlohmann::json::parse(to_json(snapshot))["config_error"] == vehicle.expected.config_error);
}

TEST_CASE("each process is held against what of the file concerns it") {
  VehicleAt vehicle;
  for (const std::string& name : vehicle.expected.processes)
    vehicle.expected.process_hashes[name] = kConfigHash;
  vehicle.expected.config_hash = kConfigHash + 1;  // of the whole file: it has keys that concern nobody
  CHECK(vehicle.snapshot().problems.empty());
  vehicle.expected.process_hashes["gvom-ingest-rear"] = kConfigHash + 1;
  CHECK(vehicle.snapshot().problems ==
        std::vector<std::string>{"gvom-ingest-rear runs with another configuration "
                                 "than the file's: gvomctl reload"});
}

TEST_CASE("of a process that is not there systemd says why") {
  VehicleAt vehicle;
  vehicle.expected.processes.emplace_back("gvom-ingest-left");
  vehicle.stopped = "gvom-ingest-left";
  vehicle.why_stopped =
      "gvom-ingest@left.service is not enabled: systemctl enable --now gvom-ingest@left.service";
  CHECK(process(vehicle.snapshot(), "gvom-ingest-left").reason ==
        "nothing was heard of it; " + vehicle.why_stopped);
}
