// The reference planner drives random worlds by the maps that are made on the way.
#include <catch2/catch.hpp>

#include "services/common/config_file.hpp"
#include "tools/drive/cli/campaign.hpp"

using namespace gvom;
using namespace gvom::driving;

TEST_CASE("the Warthog arrives in random worlds and touches nothing") {
  const auto config = services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml");
  REQUIRE(config);
  CampaignOptions options;
  options.first_seed = 8;
  options.last_seed = 9;
  options.length_m = 60;
  options.threads = 2;
  const auto rows = run_campaign(*config, options, [](const Row& row) { UNSCOPED_INFO(line_of(row)); });
  REQUIRE(rows);
  REQUIRE(rows->size() == 2);
  for (const Row& row : *rows) {
    CHECK(row.result.outcome == Outcome::arrived);
    CHECK(row.result.log.nearest_m > 0);
    REQUIRE(row.result.way);
    CHECK(row.result.log.seconds() > row.result.way->seconds);  // who knows the world is quicker
    CHECK(row.result.log.driven_m > 55);
  }
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
