// What an Ouster sensor says about itself in its metadata JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/ingest/ouster_format.hpp"

namespace gvom::ingest {

struct OusterMetadata {
  OusterLayout layout{};
  std::vector<double> beam_altitude_deg;  ///< From the topmost beam; one for each pixel of a column.
  std::vector<double> beam_azimuth_deg;
  int columns_per_frame = 0;
  int columns_per_packet = 16;
  double turns_per_s = 0;  ///< 0: not known.
  int window_first =
      0;  ///< The first and the last measurement id that the sensor sends; the window may wrap.
  int window_last = 0;
  double beam_offset_x_mm = 0;  ///< From the lidar's axis to the beams' origin, outwards.
  double beam_offset_z_mm = 0;
  std::array<double, 16> lidar_to_sensor{};  ///< Row-major, millimetres.
  std::uint64_t serial = 0;                  ///< 0: not known.

  [[nodiscard]] std::size_t beams() const { return beam_altitude_deg.size(); }
  [[nodiscard]] std::size_t packet_size() const {
    return layout.packet_size(beams(), static_cast<std::size_t>(columns_per_packet));
  }
  [[nodiscard]] int window_columns() const;
};

/// Reads the flat (firmware 1 and 2) and the nested (firmware 2.2 and later) JSON. Keys that are missing and
/// what stands in for them are added to `warnings`. Errors name the file, the key and the reason.
tl::expected<OusterMetadata, std::string> read_ouster_metadata(const std::string& path,
                                                               std::vector<std::string>& warnings);

}  // namespace gvom::ingest
