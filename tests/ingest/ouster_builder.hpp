// Builds Ouster metadata and lidar packets.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "tests/ingest/frames_builder.hpp"

namespace gvom::test {

/// A small sensor: by default two beams, level and 30 degrees up, 16 columns a turn in packets of 4.
struct OusterSensor {
  std::string profile = "LEGACY";
  std::string altitudes = "[0, 30]";
  std::string azimuths = "[0, 0]";
  std::string beam_offset_mm = "0";
  std::string transform = "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";
  std::string window = "[0, 15]";
  int beams = 2;
  int columns = 16;
  int columns_per_packet = 4;
  std::uint64_t serial = 0;  ///< 0: neither the metadata nor its packets tell it.
  std::string mode;          ///< lidar_mode; empty: the metadata has none.
  int column_ns = 1'000'000;
  int frame_ns = 100'000'000;
  int encoder_step = 0;  ///< LEGACY: the encoder's count from column to column.

  /// The time of a column in its packets.
  [[nodiscard]] std::int64_t column_time_ns(int frame, int id) const {
    return 1'000'000'000LL + std::int64_t{frame} * frame_ns + std::int64_t{id} * column_ns;
  }
  [[nodiscard]] std::string json() const {
    return R"({"beam_altitude_angles": )" + altitudes + R"(, "beam_azimuth_angles": )" + azimuths +
           R"(, "lidar_origin_to_beam_origin_mm": )" + beam_offset_mm + R"(, "lidar_to_sensor_transform": )" +
           transform + R"(, "data_format": {"columns_per_frame": )" + std::to_string(columns) +
           R"(, "columns_per_packet": )" + std::to_string(columns_per_packet) + R"(, "pixels_per_column": )" +
           std::to_string(beams) + R"(, "column_window": )" + window + R"(, "udp_profile_lidar": ")" +
           profile + "\"}" + (serial != 0 ? R"(, "prod_sn": ")" + std::to_string(serial) + "\"" : "") +
           (mode.empty() ? "" : R"(, "lidar_mode": ")" + mode + "\"") + "}";
  }
};

/// 8 beams that see the ground nearby, 64 columns a turn.
inline OusterSensor looking_down() {
  OusterSensor sensor;
  sensor.profile = "RNG19_RFL8_SIG16_NIR16";
  sensor.altitudes = "[-6, -8, -10, -12, -14, -16, -18, -20]";
  sensor.azimuths = "[0, 0, 0, 0, 0, 0, 0, 0]";
  sensor.window = "[0, 63]";
  sensor.beams = 8;
  sensor.columns = 64;
  return sensor;
}

inline std::string write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

/// What a column holds: ranges by beam, in the profile's own unit; the second return only for DUAL.
struct Column {
  int id = 0;
  std::vector<std::uint32_t> ranges;
  std::vector<std::uint32_t> second = {};
  bool valid = true;
};

/// The time of a column in the packets of a sensor of 1 ms a column.
inline std::int64_t column_time_ns(int frame, int id) {
  return OusterSensor{}.column_time_ns(frame, id);
}

/// A pixel: its range with noise in the bits that are not range, then noise.
inline void put_pixel(ByteVector& out, const OusterSensor& sensor, const Column& column, std::size_t beam) {
  const auto has = [&](const char* part) { return sensor.profile.find(part) != std::string::npos; };
  const bool narrow = has("RNG15");
  const bool dual = has("DUAL");
  const std::size_t words = narrow       ? (dual || has("ZONE") ? 2 : 1)
                            : has("RGB") ? (dual ? 5 : 4)
                            : dual       ? 4
                                         : 3;
  const std::uint32_t noise = narrow ? 0xFFFF8000 : sensor.profile == "LEGACY" ? 0xFFF00000 : 0xFFF80000;
  const std::size_t end = out.size() + 4 * words;
  put_le(out, column.ranges.at(beam) | noise);
  if (dual) put_le(out, (column.second.empty() ? 0 : column.second.at(beam)) | noise);
  out.resize(end, 0xFF);
}

/// The newer profiles' header: packet type, frame, initialization, serial number.
inline ByteVector ouster_header(const OusterSensor& sensor, int frame) {
  const bool fusa = sensor.profile.find("FUSA") == 0;
  ByteVector out;
  put_le(out, std::uint16_t{1});
  if (fusa) out.resize(4, 0xEE);
  if (fusa) put_le(out, static_cast<std::uint32_t>(frame));
  if (!fusa) put_le(out, static_cast<std::uint16_t>(frame));
  out.resize(fusa ? 11 : 7, 0xEE);
  put_le(out, sensor.serial);
  out.resize(32);
  return out;
}

inline ByteVector ouster_packet(const OusterSensor& sensor, int frame, const std::vector<Column>& columns) {
  const bool legacy = sensor.profile == "LEGACY";
  ByteVector out;
  if (!legacy) out = ouster_header(sensor, frame);
  for (const Column& column : columns) {
    put_le(out, sensor.column_time_ns(frame, column.id));
    put_le(out, static_cast<std::uint16_t>(column.id));
    if (legacy) put_le(out, static_cast<std::uint16_t>(frame));
    if (legacy) put_le(out, static_cast<std::uint32_t>(column.id * sensor.encoder_step));
    if (!legacy) put_le(out, static_cast<std::uint16_t>(column.valid ? 1 : 0));
    for (std::size_t beam = 0; beam < column.ranges.size(); ++beam) put_pixel(out, sensor, column, beam);
    if (legacy) put_le(out, column.valid ? 0xFFFFFFFFu : 0u);
  }
  if (!legacy) out.resize(out.size() + 32);
  return out;
}

/// A packet whose pixels all have the same range.
inline ByteVector plain_packet(const OusterSensor& sensor, int frame, int first_id,
                               std::uint32_t range = 5000) {
  std::vector<Column> columns;
  for (int i = 0; i < sensor.columns_per_packet; ++i) {
    columns.push_back(
        {first_id + i, std::vector<std::uint32_t>(static_cast<std::size_t>(sensor.beams), range)});
  }
  return ouster_packet(sensor, frame, columns);
}

}  // namespace gvom::test
