// The layouts of Ouster's lidar packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gvom::ingest {

/// How a pixel's first four bytes hold its range.
enum class OusterRange {
  bits20,       ///< 20 bits, mm.
  bits19,       ///< 19 bits, mm.
  bits15_by_8,  ///< 15 bits, 8 mm.
};

/// What stands in front of a packet's columns.
enum class OusterHeader { none, standard, fusa };

/// Sizes in bytes: a packet is a header, columns (each a header, pixels, a footer), a footer.
struct OusterLayout {
  std::string_view name;  ///< As the sensor's metadata spells it.
  OusterHeader header;
  OusterRange range;
  std::size_t pixel;
  std::size_t second;  ///< Where in the pixel the second return is; 0: there is none.
  std::size_t packet_header = 32;
  std::size_t column_header = 12;
  std::size_t column_footer = 0;
  std::size_t packet_footer = 32;

  [[nodiscard]] std::size_t column_size(std::size_t beams) const {
    return column_header + beams * pixel + column_footer;
  }
  [[nodiscard]] std::size_t packet_size(std::size_t beams, std::size_t columns) const {
    return packet_header + columns * column_size(beams) + packet_footer;
  }
};

/// What stands in front of and behind a column's pixels.
struct OusterColumn {
  std::uint64_t timestamp_ns;
  std::uint16_t measurement_id;
  std::uint16_t frame_id;  ///< Legacy only; else 0.
  std::uint32_t encoder;   ///< Legacy only; else 0. Of 90112 a turn.
  bool valid;
};

/// The layout of `udp_profile_lidar`; nothing if it is not supported.
std::optional<OusterLayout> find_ouster_layout(std::string_view profile);
const OusterLayout& legacy_ouster_layout();

/// The names of the supported profiles, for messages.
std::string supported_ouster_profiles();

/// The header's frame, of a larger number its last 16 bits, and the sensor's serial number. Not for `none`.
std::uint16_t ouster_frame(const OusterLayout& layout, const std::uint8_t* packet);
std::uint64_t ouster_serial(const OusterLayout& layout, const std::uint8_t* packet);

/// `column` points at a whole column of `column_size(beams)` bytes.
OusterColumn read_ouster_column(const OusterLayout& layout, const std::uint8_t* column, std::size_t beams);

}  // namespace gvom::ingest
