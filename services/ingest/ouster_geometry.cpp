#include "services/ingest/ouster_geometry.hpp"

#include <cmath>

namespace gvom::ingest {

OusterGeometry::OusterGeometry(const OusterMetadata& metadata)
    : origin_mm(std::hypot(metadata.beam_offset_x_mm, metadata.beam_offset_z_mm)),
      offset_x_mm(metadata.beam_offset_x_mm),
      offset_z_mm(metadata.beam_offset_z_mm) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kMetresPerMm = 1e-3;
  for (std::size_t i = 0; i < metadata.beams(); ++i) {
    const double azimuth = -metadata.beam_azimuth_deg[i] * kPi / 180.0;
    const double altitude = metadata.beam_altitude_deg[i] * kPi / 180.0;
    beams.push_back(
        {std::cos(azimuth) * std::cos(altitude), std::sin(azimuth) * std::cos(altitude), std::sin(altitude)});
  }
  const auto& m = metadata.lidar_to_sensor;
  for (int column = 0; column < metadata.columns_per_frame; ++column) {
    const double angle = 2.0 * kPi * (1.0 - static_cast<double>(column) / metadata.columns_per_frame);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    ColumnTransform t{};
    for (std::size_t row = 0; row < 3; ++row) {
      t[4 * row] = (m[4 * row] * c + m[4 * row + 1] * s) * kMetresPerMm;
      t[4 * row + 1] = (m[4 * row + 1] * c - m[4 * row] * s) * kMetresPerMm;
      t[4 * row + 2] = m[4 * row + 2] * kMetresPerMm;
      t[4 * row + 3] = m[4 * row + 3] * kMetresPerMm;
    }
    columns.push_back(t);
  }
}

}  // namespace gvom::ingest
