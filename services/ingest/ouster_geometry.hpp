// Where an Ouster's pixels lie in the sensor's frame.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "services/ingest/ouster_metadata.hpp"

namespace gvom::ingest {

/// The manufacturer's geometry, split so that the tables stay in the nearest cache: the direction of pixel
/// (column, beam) is the beam's direction turned by the column's encoder angle. Both are kept in double; a
/// table of all pixels' directions and offsets (6 MB for 1024 x 128) costs more to read than this costs to
/// compute.
struct OusterGeometry {
  explicit OusterGeometry(const OusterMetadata& metadata);

  struct Beam {
    double x, y, z;  ///< Unit vector in the frame that turns with the encoder.
  };
  /// The upper three rows of the turning frame's transform to the sensor's frame: millimetres to metres.
  using ColumnTransform = std::array<double, 12>;

  std::vector<Beam> beams;
  std::vector<ColumnTransform> columns;
  double origin_mm = 0;    ///< Part of the range that lies before the beams' origin.
  double offset_x_mm = 0;  ///< The beams' origin in the turning frame.
  double offset_z_mm = 0;

  struct Point {
    double x_m, y_m, z_m;
  };
  /// The place of a return of `range_mm` in the sensor's frame.
  [[nodiscard]] Point project(const ColumnTransform& t, const Beam& beam, double range_mm) const {
    const double u = range_mm - origin_mm;
    const double x = u * beam.x + offset_x_mm;
    const double y = u * beam.y;
    const double z = u * beam.z + offset_z_mm;
    return {t[0] * x + t[1] * y + t[2] * z + t[3], t[4] * x + t[5] * y + t[6] * z + t[7],
            t[8] * x + t[9] * y + t[10] * z + t[11]};
  }
};

}  // namespace gvom::ingest
