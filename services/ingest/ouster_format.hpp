// The layouts of Ouster's lidar packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gvom::ingest {

enum class OusterProfile { legacy, rng15, rng19, rng19_dual };

/// Sizes in bytes: a packet is a header, columns (each a header, pixels, a footer), a footer.
struct OusterLayout {
  OusterProfile profile;
  std::string_view name;  ///< As the sensor's metadata spells it.
  std::size_t packet_header;
  std::size_t column_header;
  std::size_t pixel;
  std::size_t column_footer;
  std::size_t packet_footer;

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
  bool valid;
};

/// The layout of `udp_profile_lidar`; nothing if it is not supported.
std::optional<OusterLayout> find_ouster_layout(std::string_view profile);
const OusterLayout& legacy_ouster_layout();

/// The names of the supported profiles, for messages.
std::string supported_ouster_profiles();

/// `column` points at a whole column of `column_size(beams)` bytes.
OusterColumn read_ouster_column(const OusterLayout& layout, const std::uint8_t* column, std::size_t beams);

}  // namespace gvom::ingest
