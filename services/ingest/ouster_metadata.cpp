#include "services/ingest/ouster_metadata.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <utility>

#include "services/ingest/metadata_reader.hpp"

namespace gvom::ingest {
namespace {

using Reader = MetadataReader;

constexpr std::size_t kMaxBeams = 512;
constexpr int kMaxColumns = 8192;
constexpr double kDefaultBeamOffsetMm = 15.806;
constexpr std::size_t kLeastRealBeams = 16;  // no sensor has fewer; what is told of all holds from there on
constexpr std::array<double, 16> kDefaultLidarToSensor{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};

std::size_t distinct(std::vector<double> angles) {
  std::sort(angles.begin(), angles.end());
  return static_cast<std::size_t>(std::unique(angles.begin(), angles.end()) - angles.begin());
}

/// Beams run from the top to the bottom, or the other way; neighbours of a real sensor may change places by a
/// little. A garbled list does not, and all of it alike is no sensor with beams.
void check_altitudes(Reader& reader, const std::vector<double>& angles) {
  constexpr const char* kKey = "beam_altitude_angles";
  constexpr double kMostBack_deg = 1;
  constexpr double kLeastRange_deg = 5;  // of a sensor 20 and more; radians stay under 2
  constexpr double kLeastDistinct = 0.9;
  if (angles.size() < 2) return;
  const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
  if (*high - *low < 1e-6) {
    return reader.fail(kKey, "all " + std::to_string(angles.size()) + " angles are " + text_of(angles[0]) +
                                 ": not those of a sensor");
  }
  if (angles.size() >= kLeastRealBeams && *high - *low < kLeastRange_deg) {
    return reader.fail(kKey, "the angles go from " + text_of(*low) + " to " + text_of(*high) +
                                 " only: expected degrees, those of a sensor");
  }
  const std::size_t different = distinct(angles);
  if (static_cast<double>(different) < kLeastDistinct * static_cast<double>(angles.size())) {
    return reader.fail(kKey, "only " + std::to_string(different) + " of " + std::to_string(angles.size()) +
                                 " angles are different: not those of a sensor");
  }
  const double down = angles.front() > angles.back() ? 1 : -1;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    if ((angles[i] - angles[i - 1]) * down < kMostBack_deg) continue;
    return reader.fail(kKey, "the angles go from " + text_of(angles[i - 1]) + " to " + text_of(angles[i]) +
                                 " where they should go on to " + text_of(angles.back()));
  }
}

/// The beams of a sensor are staggered.
void check_azimuths(Reader& reader, const std::vector<double>& angles) {
  if (angles.size() < kLeastRealBeams || distinct(angles) > 1) return;
  reader.fail("beam_azimuth_angles", "all " + std::to_string(angles.size()) + " angles are " +
                                         text_of(angles[0]) + ": not those of a sensor");
}

void read_angles(Reader& reader, OusterMetadata& out) {
  const std::pair<const char*, std::vector<double>*> lists[] = {
      {"beam_altitude_angles", &out.beam_altitude_deg}, {"beam_azimuth_angles", &out.beam_azimuth_deg}};
  for (const auto& [key, list] : lists) {
    const Json* json = reader.find({"beam_intrinsics"}, key);
    if (json == nullptr) {
      reader.fail(key, "missing");
    } else {
      *list = reader.numbers(*json, key, 90.0);
    }
  }
  const std::size_t beams = out.beam_altitude_deg.size();
  if (beams == 0 || beams > kMaxBeams) reader.fail("beam_altitude_angles", "expected 1 .. 512 angles");
  if (out.beam_azimuth_deg.size() != beams) {
    reader.fail("beam_azimuth_angles", std::to_string(out.beam_azimuth_deg.size()) + " angles, but " +
                                           std::to_string(beams) + " in beam_altitude_angles");
  }
  check_altitudes(reader, out.beam_altitude_deg);
  check_azimuths(reader, out.beam_azimuth_deg);
}

int columns_of_mode(Reader& reader) {
  const Json* mode = reader.find({"config_params"}, "lidar_mode");
  if (mode == nullptr || !mode->is_string()) {
    reader.fail("lidar_mode", "missing, and so is columns_per_frame");
    return 1;
  }
  const std::string text = mode->get<std::string>();
  int columns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
  const bool sane = error == std::errc{} && end != text.data() + text.size() && *end == 'x';
  if (!sane || columns < 1 || columns > kMaxColumns) {
    reader.fail("lidar_mode", "expected COLUMNSxRATE such as 1024x10, got '" + text + "'");
    return 1;
  }
  return columns;
}

void read_profile(Reader& reader, OusterMetadata& out) {
  out.layout = legacy_ouster_layout();
  const Json* profile =
      reader.find({"lidar_data_format", "data_format", "config_params"}, "udp_profile_lidar");
  if (profile == nullptr) return;
  const std::string name = profile->is_string() ? profile->get<std::string>() : shown(*profile);
  const auto layout = find_ouster_layout(name);
  if (!layout) {
    reader.fail("udp_profile_lidar",
                "profile " + name + " is not supported (" + supported_ouster_profiles() + ")");
    return;
  }
  out.layout = *layout;
}

/// Firmware 3.2 and later say which header packets have; before, the profile's name does.
void read_header(Reader& reader, OusterMetadata& out) {
  constexpr const char* kKey = "header_type";
  const Json* json = reader.find({"lidar_data_format", "data_format", "config_params"}, kKey);
  if (json == nullptr || out.layout.header == OusterHeader::none) return;
  if (*json == "STANDARD") {
    out.layout.header = OusterHeader::standard;
  } else if (*json == "FUSA") {
    out.layout.header = OusterHeader::fusa;
  } else {
    reader.fail(kKey, "expected STANDARD or FUSA, got " + shown(*json));
  }
}

/// The turning rate of the mode; 0 without one.
double rate_of_mode(const Reader& reader) {
  const Json* mode = reader.find({"config_params"}, "lidar_mode");
  if (mode == nullptr || !mode->is_string()) return 0;
  const std::string text = mode->get<std::string>();
  const auto x = text.find('x');
  int rate = 0;
  if (x != std::string::npos) std::from_chars(text.data() + x + 1, text.data() + text.size(), rate);
  return rate >= 1 && rate <= 50 ? rate : 0;
}

/// The angle at which a frame begins: what it does to the columns' angles is not documented.
void check_frame_offset(Reader& reader) {
  constexpr const char* kKey = "lidar_frame_azimuth_offset";
  const Json* json = reader.find({"lidar_data_format", "data_format", "config_params"}, kKey);
  if (json == nullptr || (json->is_number() && *json == 0)) return;
  reader.fail(kKey, "only 0 can be read, got " + shown(*json));
}

void read_window(Reader& reader, OusterMetadata& out) {
  const int last = out.columns_per_frame - 1;
  out.window_first = 0;
  out.window_last = last;
  const Json* window = reader.find({"lidar_data_format", "data_format"}, "column_window");
  if (window == nullptr) return;
  if (!window->is_array() || window->size() != 2)
    return reader.fail("column_window", "expected [first, last]");
  out.window_first = reader.integer((*window)[0], "column_window", 0, last);
  out.window_last = reader.integer((*window)[1], "column_window", 0, last);
}

void read_data_format(Reader& reader, OusterMetadata& out) {
  const auto format = {"lidar_data_format", "data_format"};
  read_profile(reader, out);
  read_header(reader, out);
  check_frame_offset(reader);
  out.turns_per_s = rate_of_mode(reader);
  const Json* columns = reader.find(format, "columns_per_frame");
  out.columns_per_frame = columns != nullptr ? reader.integer(*columns, "columns_per_frame", 1, kMaxColumns)
                                             : columns_of_mode(reader);
  if (const Json* json = reader.find(format, "columns_per_packet")) {
    out.columns_per_packet = reader.integer(*json, "columns_per_packet", 1, 128);
  }
  if (const Json* json = reader.find(format, "pixels_per_column")) {
    const int pixels = reader.integer(*json, "pixels_per_column", 1, kMaxBeams);
    if (static_cast<std::size_t>(pixels) != out.beams()) {
      reader.fail("pixels_per_column",
                  std::to_string(pixels) + ", but there are " + std::to_string(out.beams()) + " beam angles");
    }
  }
  if (columns == nullptr) {
    reader.warn("no data_format: taken as " + std::string(out.layout.name) + ", " +
                std::to_string(out.beams()) + " beams, " + std::to_string(out.columns_per_frame) +
                " columns");
  }
  read_window(reader, out);
}

/// Of a sensor about 14 to 28 mm; metres would be less than 1.
bool is_beam_offset(double mm) {
  return mm == 0 || (mm >= 1 && mm <= 100);
}

void read_beam_offset(Reader& reader, OusterMetadata& out) {
  if (const Json* json = reader.find({"beam_intrinsics"}, "beam_to_lidar_transform")) {
    const auto m = reader.numbers(*json, "beam_to_lidar_transform", 1000.0);
    if (m.size() != 16) return reader.fail("beam_to_lidar_transform", "expected 16 numbers");
    const bool shifts = m[0] == 1 && m[5] == 1 && m[10] == 1 && m[1] == 0 && m[2] == 0 && m[4] == 0 &&
                        m[6] == 0 && m[8] == 0 && m[9] == 0;
    if (!shifts || m[7] != 0) {
      return reader.fail("beam_to_lidar_transform", "expected a shift along x and z, and no turn");
    }
    if (!is_beam_offset(m[3])) {
      return reader.fail("beam_to_lidar_transform",
                         "expected a shift of 0 or 1 .. 100 mm along x, got " + text_of(m[3]));
    }
    out.beam_offset_x_mm = m[3];
    out.beam_offset_z_mm = m[11];
    return;
  }
  const Json* json = reader.find({"beam_intrinsics"}, "lidar_origin_to_beam_origin_mm");
  if (json == nullptr) {
    out.beam_offset_x_mm = kDefaultBeamOffsetMm;
    return reader.warn("no lidar_origin_to_beam_origin_mm: 15.806 stands in for it");
  }
  if (!json->is_number() || !is_beam_offset(json->get<double>())) {
    return reader.fail("lidar_origin_to_beam_origin_mm",
                       "expected millimetres, 0 or 1 .. 100, got " + shown(*json));
  }
  out.beam_offset_x_mm = json->get<double>();
}

bool is_rigid(const std::array<double, 16>& m) {
  constexpr double kTolerance = 1e-3;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      double dot = 0;
      for (int k = 0; k < 3; ++k) dot += m[4 * a + k] * m[4 * b + k];
      if (std::abs(dot - (a == b ? 1.0 : 0.0)) > kTolerance) return false;
    }
  }
  const double mirrors =  // the determinant: -1 if they do
      m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
      m[2] * (m[4] * m[9] - m[5] * m[8]);
  return mirrors > 0 && m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
}

void read_lidar_to_sensor(Reader& reader, OusterMetadata& out) {
  constexpr const char* kKey = "lidar_to_sensor_transform";
  out.lidar_to_sensor = kDefaultLidarToSensor;
  const Json* json = reader.find({"lidar_intrinsics"}, kKey);
  if (json == nullptr) {
    return reader.warn(
        "no lidar_to_sensor_transform: that of an OS1 stands in for it (180 degrees about z, 36.18 mm up)");
  }
  const auto m = reader.numbers(*json, kKey, 10000.0);
  if (m.size() != 16) return reader.fail(kKey, "expected 16 numbers");
  std::copy(m.begin(), m.end(), out.lidar_to_sensor.begin());
  if (!is_rigid(out.lidar_to_sensor)) reader.fail(kKey, "not a rigid transform");
}

std::uint64_t read_serial(const Reader& reader) {
  const Json* json = reader.find({"sensor_info"}, "prod_sn");
  std::uint64_t serial = 0;
  if (json == nullptr || !json->is_string()) return serial;
  const std::string text = json->get<std::string>();
  std::from_chars(text.data(), text.data() + text.size(), serial);
  return serial;
}

}  // namespace

int OusterMetadata::window_columns() const {
  const int span = window_last - window_first;
  return 1 + (span >= 0 ? span : span + columns_per_frame);
}

tl::expected<OusterMetadata, std::string> read_ouster_metadata(const std::string& path,
                                                               std::vector<std::string>& warnings) {
  std::ifstream file(path);
  if (!file) return tl::unexpected(path + ": cannot read the sensor's metadata");
  Json root;
  try {
    root = Json::parse(file);
  } catch (const Json::exception& error) {
    return tl::unexpected(path + ": not JSON: " + error.what());
  }
  if (!root.is_object()) return tl::unexpected(path + ": not a JSON object");
  OusterMetadata out;
  Reader reader(root, path, warnings);
  read_angles(reader, out);
  read_data_format(reader, out);
  read_beam_offset(reader, out);
  read_lidar_to_sensor(reader, out);
  out.serial = read_serial(reader);
  if (!reader.error().empty()) return tl::unexpected(reader.error());
  if (out.packet_size() > 65507) return tl::unexpected(path + ": packets of more than 65507 bytes");
  return out;
}

}  // namespace gvom::ingest
