// Campaigns: what is driven, and with what. That the planner arrives is in test_ten_worlds.cpp.
#include <catch2/catch.hpp>

#include <map>

#include "services/common/config_file.hpp"
#include "services/common/mcap/mcap_reader.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/drive/cli/campaign.hpp"

using namespace gvom;
using namespace gvom::driving;

namespace {

/// Messages of each topic.
std::map<std::string, std::size_t> messages_in(const std::string& path) {
  auto file = mcap::McapReader::open(path);
  REQUIRE(file);
  std::map<std::string, std::size_t> count;
  mcap::Message message;
  while (file->next(message).value()) ++count[message.channel->topic];
  CHECK(file->damaged() == 0);
  return count;
}

}  // namespace

TEST_CASE("a campaign drives what it has not driven, and every lidar is what the vehicle's file says") {
  const auto config = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml");
  REQUIRE(config);
  CampaignOptions options;
  options.first_seed = 8;
  options.last_seed = 9;
  options.driven = {8};
  options.length_m = 40;
  const test::TemporaryFolder folder;
  options.keeping = {folder.path(), Strips::none, true};
  std::vector<std::uint64_t> ended;
  const auto rows = run_campaign(*config, options, [&](const Row& row) { ended.push_back(row.seed); });
  REQUIRE(rows);
  REQUIRE(rows->size() == 1);
  CHECK(ended == std::vector<std::uint64_t>{9});
  CHECK(rows->front().seed == 9);
  CHECK(rows->front().result.outcome == Outcome::arrived);
  const auto messages = messages_in(folder.path() + "/" + rows->front().world + "-9.mcap");
  const std::size_t turns = rows->front().result.log.steps.size();
  for (const char* topic : {"/gvom/costmap", "/gvom/layers", "/tf", "/gvom/plan", "/gvom/trajectory"})
    CHECK(messages.at(topic) == turns);
  CHECK(sensor_of(*config) == sim::Sensor::os1_64);
  const auto moose = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/moose.yaml");
  REQUIRE(moose);
  CHECK(sensor_of(*moose) == sim::Sensor::os1_128);
}

TEST_CASE("a vehicle that plans at another rate than the lidars turn is refused") {
  const auto config =
      services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml", {"planner.rate_hz=20"});
  REQUIRE(config);
  CampaignOptions options;
  options.first_seed = options.last_seed = 9;
  options.length_m = 40;
  const auto rows = run_campaign(*config, options, [](const Row&) {});
  REQUIRE_FALSE(rows);
  CHECK(rows.error().find("warthog.yaml: planner.rate_hz: in lock-step it plans once a turn, at 10 Hz") !=
        std::string::npos);
}

TEST_CASE("one lidar of a vehicle that has one cannot be silent") {
  const auto config = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml");
  REQUIRE(config);
  CampaignOptions options;
  options.first_seed = options.last_seed = 9;
  options.length_m = 40;
  options.ablation = Ablation::one_lidar;
  const auto rows = run_campaign(*config, options, [](const Row&) {});
  REQUIRE_FALSE(rows);
  CHECK(rows.error().find("one-lidar") != std::string::npos);
}

TEST_CASE("seeds are one number or a span") {
  CampaignOptions options;
  CHECK(read_seeds("7", options));
  CHECK((options.first_seed == 7 && options.last_seed == 7));
  CHECK(read_seeds("3..12", options));
  CHECK((options.first_seed == 3 && options.last_seed == 12));
  for (const char* wrong : {"", "x", "3..", "..3", "5..4", "1.5", "1..2..3"})
    CHECK_FALSE(read_seeds(wrong, options));
}
