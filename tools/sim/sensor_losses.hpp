// Which returns a sensor loses: those that are too weak.
#pragma once

#include <cstdint>

#include "tools/sim/world.hpp"

namespace gvom::sim {

/// What comes back is proportional to reflectivity * incidence / range^2. A target of `reflectivity_percent`
/// that is square to the beam is seen half of the time at `half_seen_m`; the chance goes with the sixth power
/// of what comes back, so it falls from 90 to 10 % within 1.44 times the range.
///
/// The default: of 10 % targets 90 % are seen at 35 m, 80 % at 37 m, 50 % at 42 m, as the data sheets of the
/// first two generations of OS1 have it (10 %: 35 to 45 m). Of bare level ground seen from 1.4 m that leaves
/// 97 % at 20 m, 68 % at 26 m, 44 % at 31 m, 14 % at 40 m, 1 % at 51 m. A real OS1-64 saw 93, 57, 44, 25 and
/// 12 % (RELLIS-3D, concrete and grass, one sweep).
struct SensorLosses {
  bool enabled = true;
  double reflectivity_percent = 10.0;
  double half_seen_m = 42.0;
  /// Rough ground is not Lambert's: seen at a graze it shows the sides of its grains. The incidence counts as
  /// this where the ray is parallel to the surface, as 1 where it is square to it, linear in its cosine in
  /// between.
  double grazing_incidence = 0.25;
};

/// The chance that the sensor sees `hit`, 0 .. 1.
double chance_of(const Hit& hit, const SensorLosses& losses);

}  // namespace gvom::sim
