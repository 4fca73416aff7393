#include "services/ingest/hits.hpp"

#include <cmath>

namespace gvom::ingest {

bool Hits::add(double x_m, double y_m, double z_m) {
  const bool finite = std::isfinite(x_m) && std::isfinite(y_m) && std::isfinite(z_m);
  if (!finite || (x_m == 0 && y_m == 0 && z_m == 0)) return false;
  ++count_;
  if (x_m * x_m + y_m * y_m + z_m * z_m > kFarHitM * kFarHitM) ++far_;
  return true;
}

tl::expected<void, std::string> Hits::judge() const {
  if (2 * far_ <= count_) return {};
  return tl::unexpected(std::to_string(far_) + " of its " + std::to_string(count_) +
                        " hits are beyond 500 m: not metres?");
}

}  // namespace gvom::ingest
