// The ground around the vehicle, out of one sweep. No bus, no memory of its own.
#pragma once

#include <optional>

#include "core/config.hpp"
#include "core/sweep.hpp"

namespace gvom::ingest {

/// The ground in base_link near the vehicle: z = height_m + slope_x x + slope_y y.
struct GroundPlane {
  double height_m;  ///< At base_link's origin.
  double slope_x;   ///< m/m
  double slope_y;   ///< m/m
};

/// The plane that the lowest returns between 3 and 15 m around base_link lie on, cell by cell of 15 degrees
/// and 1.5 m. Nothing where less than half of the cells with returns are on one plane, or these are all at
/// one distance or in one line: in a wood, in a narrow room, or where hardly any ground is seen. The same
/// sweep gives the same plane.
std::optional<GroundPlane> find_ground(const Sweep& sweep, const LidarGeometry& lidar,
                                       const VehicleGeometry& vehicle);

}  // namespace gvom::ingest
