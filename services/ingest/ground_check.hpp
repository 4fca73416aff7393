// Whether the ground is where T_base_sensor and vehicle.base_height_m put it, over many sweeps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/config.hpp"
#include "core/sweep.hpp"
#include "ipc/messages.hpp"
#include "services/common/words.hpp"
#include "services/ingest/ground_plane.hpp"

namespace gvom::ingest {

/// Looks at a sweep each half second, at first at each, and takes medians over the last 16 s in which ground
/// was found. Where the vehicle has come 8 m on in these, 0.2 m or 0.07 rad are wrong: slopes, ditches and
/// kerbs do not last so long. Where it stands, they may: only 0.5 m or 0.2 rad are.
class GroundCheck {
 public:
  GroundCheck(const LidarGeometry& lidar, const VehicleGeometry& vehicle);

  /// A sweep that was mapped, and where base_link was then, in odom.
  void see(const Sweep& sweep, const Eigen::Vector3d& base_position_m);

  [[nodiscard]] const ipc::Ground& ground() const { return ground_; }
  [[nodiscard]] bool is_wrong() const;
  /// Nothing unless it is wrong.
  void describe(services::Words& words) const;

 private:
  static constexpr std::size_t kLooks = 32;
  struct Look {
    GroundPlane plane;
    std::int64_t stamp_ns;
    Eigen::Vector3d base_position_m;
  };

  void forget_old(std::int64_t stamp_ns);
  void judge();
  [[nodiscard]] float median(double GroundPlane::*value) const;

  const LidarGeometry lidar_;
  const VehicleGeometry vehicle_;
  std::array<Look, kLooks> looks_{};  // oldest first
  std::size_t count_ = 0;
  std::int64_t looked_ns_ = 0;
  bool has_looked_ = false;
  ipc::Ground ground_{};
  bool is_high_ = false;  // or low
  bool is_tilted_ = false;
};

}  // namespace gvom::ingest
