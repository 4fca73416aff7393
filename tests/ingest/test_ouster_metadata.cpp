#include <algorithm>
#include <filesystem>

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
  for (const char* profile : {"FIVE_WORD_PIXEL", "OFF", "RNG99"}) {
    sensor.profile = profile;
    check_error(sensor.json(), "profile " + sensor.profile + " is not supported (LEGACY, RNG15_RFL8_NIR8");
  }
}

TEST_CASE("beam angles that no sensor has are refused") {
  OusterSensor sensor;
  sensor.beams = 4;
  sensor.azimuths = "[3, 1, -1, -3]";
  sensor.altitudes = "[0, 0, 0, 0]";
  check_error(sensor.json(), "beam_altitude_angles: all 4 angles are 0: not those of a sensor");
  sensor.altitudes = "[12.5, 12.5, 12.5, 12.5]";
  check_error(sensor.json(), "beam_altitude_angles: all 4 angles are 12.5");
  sensor.altitudes = "[15, 5, 85, -15]";
  check_error(sensor.json(),
              "beam_altitude_angles: the angles go from 5 to 85 where they should go on to -15");
  sensor.altitudes = "[-15, -5, -9, 15]";
  check_error(sensor.json(), "the angles go from -5 to -9 where they should go on to 15");
  sensor.altitudes = "[15, 5, 5.3, -15]";
  CHECK(read(sensor.json()).metadata.has_value());
  sensor.altitudes = "[15, 5, 1e999, -15]";
  CHECK_FALSE(read(sensor.json()).metadata.has_value());
}

TEST_CASE("lists of angles that are garbled in part, of 16 beams and more, are refused") {
  const auto list = [](auto angle) {
    std::string text;
    for (int beam = 0; beam < 128; ++beam) text += (beam == 0 ? "[" : ", ") + std::to_string(angle(beam));
    return text + "]";
  };
  const auto altitude = [](int beam) { return 21.0 - beam / 3.0; };
  OusterSensor good;
  good.beams = 128;
  good.altitudes = list(altitude);
  good.azimuths = list([](int beam) { return beam % 2 == 0 ? 3.0 : -3.0; });
  CHECK(read(good.json()).metadata.has_value());
  OusterSensor sensor = good;
  sensor.azimuths = list([](int) { return 0.0; });
  check_error(sensor.json(), "beam_azimuth_angles: all 128 angles are 0: not those of a sensor");
  sensor = good;
  sensor.altitudes = list([&](int beam) { return altitude(std::max(beam, 63)); });
  check_error(sensor.json(), "beam_altitude_angles: only 65 of 128 angles are different");
  sensor.altitudes = list([&](int beam) { return altitude(beam / 2 * 2); });
  check_error(sensor.json(), "beam_altitude_angles: only 64 of 128 angles are different");
  sensor.altitudes = list([&](int beam) { return beam < 64 ? altitude(beam) : 0.0; });
  check_error(sensor.json(), "beam_altitude_angles: only 64 of 128 angles are different");
  sensor.altitudes = list([&](int beam) { return altitude(beam) * 0.0174533; });
  check_error(sensor.json(), "beam_altitude_angles: the angles go from -0.3723");
}

TEST_CASE("a beam's origin that is no sensor's is refused") {
  OusterSensor sensor;
  for (const char* good : {"0", "1", "15.806", "27.67", "100"}) {
    sensor.beam_offset_mm = good;
    CHECK(read(sensor.json()).metadata.has_value());
  }
  for (const char* bad : {"0.015806", "-15.806", "158.06", "1e999"}) {
    sensor.beam_offset_mm = bad;
    CHECK_FALSE(read(sensor.json()).metadata.has_value());
    if (std::string(bad) == "1e999") continue;  // not JSON
    check_error(sensor.json(), "lidar_origin_to_beam_origin_mm: expected millimetres, 0 or 1 .. 100, got");
  }
}

TEST_CASE("transforms that no sensor has are refused") {
  OusterSensor sensor;
  sensor.transform = "[1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1]";  // a mirror
  check_error(sensor.json(), "lidar_to_sensor_transform: not a rigid transform");
  sensor.transform = "[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]";
  check_error(sensor.json(), "lidar_to_sensor_transform: not a rigid transform");
  const auto beam = [](const std::string& matrix) {
    return R"({"beam_altitude_angles": [1], "beam_azimuth_angles": [3], "lidar_mode": "512x20", )"
           R"("beam_to_lidar_transform": )" +
           matrix + "}";
  };
  check_error(beam("[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]"), "beam_to_lidar_transform: expected a shift");
  check_error(beam("[1,0,0,9, 0,1,0,3, 0,0,1,0, 0,0,0,1]"), "beam_to_lidar_transform: expected a shift");
  check_error(beam("[1,0,0,0.016, 0,1,0,0, 0,0,1,0, 0,0,0,1]"),
              "beam_to_lidar_transform: expected a shift of 0 or 1 .. 100 mm along x, got 0.016");
  CHECK(read(beam("[1,0,0,9, 0,1,0,0, 0,0,1,2, 0,0,0,1]")).metadata.has_value());
}

TEST_CASE("firmware 3.2: the header's kind is a key; a frame that begins elsewhere is refused") {
  const auto json = [](const std::string& more) {
    return R"({"beam_intrinsics": {"beam_altitude_angles": [1, -1], "beam_azimuth_angles": [3, -3]},
               "lidar_data_format": {"columns_per_frame": 16, "columns_per_packet": 4, "pixels_per_column": 2,
               "udp_profile_lidar": "RNG15_RFL8_NIR8_DUAL", )" +
           more + "}}";
  };
  CHECK(read(json(R"("header_type": "STANDARD")")).metadata->layout.header == ingest::OusterHeader::standard);
  CHECK(read(json(R"("header_type": "FUSA")")).metadata->layout.header == ingest::OusterHeader::fusa);
  check_error(json(R"("header_type": "SHORT")"), "header_type: expected STANDARD or FUSA, got \"SHORT\"");
  CHECK(read(json(R"("lidar_frame_azimuth_offset": 0)")).metadata.has_value());
  check_error(json(R"("lidar_frame_azimuth_offset": 90000)"),
              "lidar_frame_azimuth_offset: only 0 can be read");
}

TEST_CASE("all real metadata is read, but what is garbled") {
  const auto data = recordings();
  if (!data) return;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data)) {
    const std::string path = entry.path();
    if (entry.path().extension() != ".json" || path.find("garbled") != std::string::npos) continue;
    std::vector<std::string> warnings;
    const auto read = ingest::read_ouster_metadata(path, warnings);
    INFO(path << ": " << (read ? "" : read.error()));
    CHECK(read.has_value());
    ++files;
  }
  CHECK(files >= 8);
}

TEST_CASE("real metadata: garbled angles are refused, those of firmware 3.1 and 3.2 are read") {
  const auto data = recordings();
  if (!data) return;
  std::vector<std::string> warnings;
  const auto garbled = ingest::read_ouster_metadata(
      *data + "/field/ouster_metadata_garbled/complete_but_all_zeros_legacy.json", warnings);
  REQUIRE_FALSE(garbled.has_value());
  CHECK(garbled.error().find("beam_altitude_angles: all 128 angles are 0") != std::string::npos);
  for (const char* name : {"785", "imu_zm_no_lidar_0"}) {
    const auto zones =
        ingest::read_ouster_metadata(*data + "/field/ouster_zone16/" + name + ".json", warnings);
    INFO((zones ? "" : zones.error()));
    REQUIRE(zones.has_value());
    CHECK(zones->packet_size() == 24832);
    CHECK(zones->serial == 122247000785);
  }
  CHECK(warnings.empty());
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
