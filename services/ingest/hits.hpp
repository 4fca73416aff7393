// Which points of a scan are hits, and whether they can be in metres.
#pragma once

#include <cstddef>
#include <string>

#include <tl/expected.hpp>

namespace gvom::ingest {

/// Beyond the range of any lidar of a vehicle (300 m); half of the hits of the scans that were looked at are
/// beyond 6 to 10 m, which is 600 to 1000 if centimetres are taken for metres.
inline constexpr double kFarHitM = 500;

class Hits {
 public:
  /// Whether the point is one: numbers, and not all zero.
  bool add(double x_m, double y_m, double z_m);

  [[nodiscard]] std::size_t count() const { return count_; }
  /// An error if most are beyond kFarHitM.
  [[nodiscard]] tl::expected<void, std::string> judge() const;

 private:
  std::size_t count_ = 0;
  std::size_t far_ = 0;
};

}  // namespace gvom::ingest
