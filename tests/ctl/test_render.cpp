// What a person and a script are shown of it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/ctl/vehicle_at.hpp"
#include "tools/ctl/render.hpp"

using namespace gvom;
using namespace gvom::test;
using Catch::Matchers::Contains;
using ipc::HealthState;

TEST_CASE("the table shows what is wrong first, and every figure") {
  VehicleAt vehicle;
  const std::string well = to_table(vehicle.snapshot());
  CHECK_THAT(well, Contains("two_lidars: all is well\n"));
  CHECK_THAT(
      well,
      Contains("gvom-fusion             ok           10.0/s     0.5 s    0.08 s         2     50 MB\n"));
  CHECK_THAT(well, Contains("    dropped: 95 overrun (+10/s)\n") && !Contains("no_chunk"));
  CHECK_THAT(well,
             Contains("layers: 0.08 s old, published 0.05 s ago, 8 maps in the window, missing: no lidar\n"));
  CHECK_THAT(well, Contains("odometry: 0.00 s old, 20.0/s\n"));
  CHECK_THAT(well, Contains("2000                            10        3             2\n"));
  vehicle.expected.processes.emplace_back("gvom-ingest-left");
  CHECK_THAT(to_table(vehicle.snapshot()),
             Contains("two_lidars: 1 problem\n  ! gvom-ingest-left is missing: nothing was heard of it\n"));
}

TEST_CASE("JSON has every figure, and null for what is not known") {
  const auto json = nlohmann::json::parse(to_json(VehicleAt().snapshot()));
  CHECK(json["vehicle"] == "two_lidars");
  CHECK(json["ok"] == true);
  CHECK(json["broker"] == "up");
  const auto& fusion = json["processes"][2];
  CHECK(fusion["name"] == "gvom-fusion");
  CHECK(fusion["state"] == "ok");
  CHECK(fusion["restarts"] == 2);
  CHECK(fusion["memory_bytes"] == 50'000'000);
  CHECK(fusion["counters"]["sweeps_in"] == 95);
  CHECK(fusion["drops"]["overrun"]["count"] == 95);
  CHECK(fusion["drops"]["overrun"]["per_s"].get<double>() == Approx(10.0));
  CHECK(json["processes"][0]["rate_hz"].is_null());
  CHECK(json["layers"]["missing"].empty());
  CHECK(json["layers"]["lidars"]["rear"]["maps_in_window"] == 4);
  CHECK(json["pools"][1]["min_free"] == 2);
  VehicleAt nothing_heard;
  nothing_heard.observed = {};
  const auto empty = nlohmann::json::parse(to_json(nothing_heard.snapshot()));
  CHECK(empty["ok"] == false);
  CHECK(empty["layers"].is_null());
  CHECK(empty["odometry"].is_null());
}

TEST_CASE("where a lidar sees the ground is told, also that it was not judged") {
  VehicleAt vehicle;
  vehicle.observed.add(ground_of("gvom-ingest-front", ipc::GroundVerdict::well, -0.05f, 0.01f));
  ipc::Health rear = health_of("gvom-ingest-rear", HealthState::ok, kNow_ns);
  rear.ground.verdict = static_cast<std::uint32_t>(ipc::GroundVerdict::not_judged);
  vehicle.observed.add(rear);
  const ctl::Snapshot snapshot = vehicle.snapshot();
  CHECK(snapshot.problems.empty());
  CHECK_THAT(
      to_table(snapshot),
      Contains("    ground: well: 0.05 m below where it should be, tilted by 0.6 degrees, in 20 sweeps "
               "on the way\n") &&
          Contains("    ground: not judged: too little of it is seen"));
  const auto json = nlohmann::json::parse(to_json(snapshot));
  CHECK(json["processes"][3]["ground"]["verdict"] == "well");
  CHECK(json["processes"][3]["ground"]["height_m"] == Approx(-0.05));
  CHECK(json["processes"][4]["ground"]["verdict"] == "not judged");
  CHECK(json["processes"][4]["ground"]["height_m"].is_null());
  CHECK(json["processes"][2]["ground"].is_null());
  CHECK_THAT(to_prometheus(snapshot), Contains(R"(gvom_ground_judged{process="gvom-ingest-rear"} 0)") &&
                                          Contains(R"(gvom_ground_wrong{process="gvom-ingest-front"} 0)"));
}
