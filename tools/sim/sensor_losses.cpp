#include "tools/sim/sensor_losses.hpp"

namespace gvom::sim {

double chance_of(const Hit& hit, const SensorLosses& losses) {
  if (!losses.enabled) return 1.0;
  const double incidence = losses.grazing_incidence + (1.0 - losses.grazing_incidence) * hit.cos_incidence;
  const double nearness = losses.half_seen_m / hit.range_m;
  const double power = hit.reflectivity / losses.reflectivity_percent * incidence * nearness * nearness;
  const double square = power * power;
  const double sixth = square * square * square;
  return sixth / (1.0 + sixth);
}

}  // namespace gvom::sim
