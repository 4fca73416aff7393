#include "services/ingest/ouster_metadata.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <utility>

#include <nlohmann/json.hpp>

namespace gvom::ingest {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxBeams = 512;
constexpr int kMaxColumns = 8192;
constexpr double kDefaultBeamOffsetMm = 15.806;
constexpr std::array<double, 16> kDefaultLidarToSensor{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};

/// A value for a message: short, and of a nested one only what it is (text is made of it recursively).
std::string shown(const Json& json) {
  constexpr std::size_t kLongest = 60;
  if (json.is_structured()) return std::string("an ") + json.type_name();
  const std::string text = json.dump();
  return text.size() <= kLongest
             ? text
             : std::string(json.type_name()) + " of " + std::to_string(text.size()) + " characters";
}

/// Reads keys one by one and remembers the first thing that is wrong.
class Reader {
 public:
  Reader(const Json& root, std::string path, std::vector<std::string>& warnings)
      : root_(root), path_(std::move(path)), warnings_(warnings) {}

  /// `key` in the first of `sections` that has it, else at the top; null if it is nowhere.
  const Json* find(std::initializer_list<const char*> sections, const char* key) const {
    for (const char* section : sections) {
      const auto found = root_.find(section);
      if (found != root_.end() && found->is_object() && found->contains(key)) return &(*found)[key];
    }
    const auto found = root_.find(key);
    return found == root_.end() ? nullptr : &*found;
  }

  std::vector<double> numbers(const Json& json, const char* key, double limit) {
    std::vector<double> values;
    if (!json.is_array()) fail(key, "expected a list of numbers");
    for (const Json& item : json) {
      const double value = item.is_number() ? item.get<double>() : std::nan("");
      if (!(std::abs(value) <= limit)) {
        fail(key, "expected numbers of at most " + std::to_string(static_cast<int>(limit)) + ", got " +
                      shown(item));
        break;
      }
      values.push_back(value);
    }
    return values;
  }

  int integer(const Json& json, const char* key, int low, int high) {
    const bool fits = json.is_number_integer() && json >= low && json <= high;
    if (fits) return json.get<int>();
    fail(key, "expected a whole number of " + std::to_string(low) + " .. " + std::to_string(high) + ", got " +
                  shown(json));
    return low;
  }

  void fail(const std::string& key, const std::string& reason) {
    if (error_.empty()) error_ = path_ + ": " + key + ": " + reason;
  }
  void warn(const std::string& text) { warnings_.push_back(path_ + ": " + text); }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  const Json& root_;
  std::string path_;
  std::vector<std::string>& warnings_;
  std::string error_;
};

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

void read_beam_offset(Reader& reader, OusterMetadata& out) {
  if (const Json* json = reader.find({"beam_intrinsics"}, "beam_to_lidar_transform")) {
    const auto m = reader.numbers(*json, "beam_to_lidar_transform", 1000.0);
    if (m.size() != 16) return reader.fail("beam_to_lidar_transform", "expected 16 numbers");
    out.beam_offset_x_mm = m[3];
    out.beam_offset_z_mm = m[11];
    return;
  }
  const Json* json = reader.find({"beam_intrinsics"}, "lidar_origin_to_beam_origin_mm");
  if (json == nullptr) {
    out.beam_offset_x_mm = kDefaultBeamOffsetMm;
    return reader.warn("no lidar_origin_to_beam_origin_mm: 15.806 stands in for it");
  }
  if (!json->is_number() || !(std::abs(json->get<double>()) <= 1000.0)) {
    return reader.fail("lidar_origin_to_beam_origin_mm", "expected millimetres, got " + shown(*json));
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
  return m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
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
