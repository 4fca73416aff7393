#include "services/ingest/ouster_metadata.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::OusterMetadata;

namespace {

struct Read {
  tl::expected<OusterMetadata, std::string> metadata;
  std::vector<std::string> warnings;
};

Read read(const std::string& json) {
  TemporaryFolder folder;
  Read out{tl::unexpected(std::string()), {}};
  out.metadata = ingest::read_ouster_metadata(write_text(folder.path() + "/meta.json", json), out.warnings);
  return out;
}

void check_error(const std::string& json, const std::string& part) {
  const auto result = read(json);
  REQUIRE_FALSE(result.metadata.has_value());
  INFO(result.metadata.error());
  CHECK(result.metadata.error().find(part) != std::string::npos);
  CHECK(result.metadata.error().find("meta.json") != std::string::npos);
}

}  // namespace

TEST_CASE("the nested layout says the same as the flat one") {
  const auto nested = read(R"({
    "sensor_info": {"prod_sn": "122201000998"},
    "beam_intrinsics": {"beam_altitude_angles": [1, -1], "beam_azimuth_angles": [3, -3],
                        "lidar_origin_to_beam_origin_mm": 13.762,
                        "beam_to_lidar_transform": [1,0,0,13.762, 0,1,0,0, 0,0,1,2, 0,0,0,1]},
    "lidar_intrinsics": {"lidar_to_sensor_transform": [-1,0,0,0, 0,-1,0,0, 0,0,1,78.296, 0,0,0,1]},
    "lidar_data_format": {"columns_per_frame": 2048, "columns_per_packet": 8, "pixels_per_column": 2,
                          "column_window": [100, 299], "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"},
    "config_params": {"lidar_mode": "1024x10"}})");
  REQUIRE(nested.metadata.has_value());
  const OusterMetadata& m = *nested.metadata;
  CHECK(nested.warnings.empty());
  CHECK(m.serial == 122201000998);
  CHECK(m.beam_azimuth_deg == std::vector<double>{3, -3});
  CHECK(m.beam_offset_x_mm == 13.762);
  CHECK(m.beam_offset_z_mm == 2);
  CHECK(m.lidar_to_sensor[11] == 78.296);
  CHECK(m.columns_per_frame == 2048);
  CHECK(m.window_columns() == 200);
  CHECK(m.packet_size() == 32 + 8 * (12 + 2 * 12) + 32);
}

TEST_CASE("missing keys: the documented values stand in, each with a warning") {
  const auto bare =
      read(R"({"beam_altitude_angles": [1], "beam_azimuth_angles": [3], "lidar_mode": "512x20"})");
  REQUIRE(bare.metadata.has_value());
  CHECK(bare.warnings.size() == 3);
  CHECK(bare.metadata->layout.name == "LEGACY");
  CHECK(bare.metadata->columns_per_frame == 512);
  CHECK(bare.metadata->columns_per_packet == 16);
  CHECK(bare.metadata->window_columns() == 512);
  CHECK(bare.metadata->beam_offset_x_mm == 15.806);
  CHECK(bare.metadata->lidar_to_sensor[0] == -1);
  CHECK(bare.metadata->lidar_to_sensor[11] == 36.18);
}

TEST_CASE("what cannot be right is refused, naming file and key") {
  check_error("{", "not JSON");
  check_error("[1]", "not a JSON object");
  check_error("{}", "beam_altitude_angles: missing");
  OusterSensor sensor;
  sensor.azimuths = "[1, 2, 3]";
  check_error(sensor.json(), "3 angles, but 2");
  sensor = {};
  sensor.altitudes = "[1, 200]";
  check_error(sensor.json(), "beam_altitude_angles: expected numbers of at most 90, got 200");
  sensor = {};
  sensor.altitudes = "[1, null]";
  check_error(sensor.json(), "got null");
  sensor = {};
  sensor.beams = 3;
  check_error(sensor.json(), "pixels_per_column: 3, but there are 2 beam angles");
  sensor = {};
  sensor.window = "[0, 16]";
  check_error(sensor.json(), "column_window");
  sensor = {};
  sensor.columns = 0;
  check_error(sensor.json(), "columns_per_frame");
  sensor = {};
  sensor.transform = "[1,0,0,0, 0,1,0,0, 0,0,2,0, 0,0,0,1]";
  check_error(sensor.json(), "not a rigid transform");
  sensor = {};
  sensor.beam_offset_mm = "\"x\"";
  check_error(sensor.json(), "lidar_origin_to_beam_origin_mm");
  check_error(R"({"beam_altitude_angles": [1], "beam_azimuth_angles": [3]})", "lidar_mode: missing");
  check_error(R"({"beam_altitude_angles": [1], "beam_azimuth_angles": [3], "lidar_mode": "fast"})",
              "got 'fast'");
}

TEST_CASE("a profile that is not supported is refused by name") {
  OusterSensor sensor;
  sensor.profile = "FUSA_RNG15_RFL8_NIR8_DUAL";
  check_error(sensor.json(), "profile FUSA_RNG15_RFL8_NIR8_DUAL is not supported (LEGACY, RNG15_RFL8_NIR8");
}

TEST_CASE("a value that is nested without end is refused, not printed") {
  constexpr std::size_t kDepth = 200000;  // text made of it recursively would need more stack than there is
  OusterSensor sensor;
  sensor.altitudes = "[0, " + std::string(kDepth, '[') + std::string(kDepth, ']') + "]";
  check_error(sensor.json(), "beam_altitude_angles: expected numbers of at most 90, got an array");
  sensor = {};
  sensor.window = "[\"" + std::string(1000, 'x') + "\", 1]";
  check_error(sensor.json(), "got string of 1002 characters");
}
