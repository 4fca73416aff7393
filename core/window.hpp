// Which buffer maps the fused map is the sum of (R7).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/format/brick_map.hpp"
#include "core/pose.hpp"

namespace gvom {

/// A buffer map with where it came from.
struct WindowMap {
  BrickMapView view;
  int lidar = 0;            ///< Index of the lidar, 0 .. kMaxLidars - 1.
  std::uint64_t token = 0;  ///< The owner's handle; handed back when the map has left.
  std::uint32_t place = 0;  ///< The back end's own handle.
};

enum class AddResult {
  added,
  too_old,     ///< Older than `max_age` before the newest stamp, or than the lidar's last maps.
  duplicate,   ///< The lidar's map of this stamp is there.
  wrong_grid,  ///< Another size or resolution.
};

/// Of what moment the fused map and its layers are (R7).
struct LayerMoment {
  Grid grid;
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;
};

/// The set of maps of R7, newest first. It depends on which maps came, not on their order. Allocates at
/// construction only.
class Window {
 public:
  Window(const WindowConfig& config, const Grid& shape);

  /// Adds a map and takes out those that it displaces: they are in `left()` until the next call.
  AddResult add(const WindowMap& map);
  /// Takes all maps out, into `left()`.
  void clear();

  [[nodiscard]] const std::vector<WindowMap>& maps() const { return maps_; }
  [[nodiscard]] const std::vector<WindowMap>& left() const { return left_; }
  /// That the window can have, or lose, at a time.
  [[nodiscard]] std::size_t most_maps() const { return maps_.capacity(); }
  [[nodiscard]] int count(int lidar) const { return counts_[static_cast<std::size_t>(lidar)]; }

 private:
  [[nodiscard]] AddResult judge(const WindowMap& map) const;
  void take_out(std::size_t index);

  Grid shape_;
  int buffer_size_;
  std::int64_t max_age_ns_;
  std::vector<WindowMap> maps_;  // by stamp, newest first; equal stamps by lidar
  std::vector<WindowMap> left_;
  std::array<int, kMaxLidars> counts_{};
};

/// The newest map's moment. The window must not be empty.
inline LayerMoment newest_moment(const Window& window) {
  const BrickMapView& newest = window.maps().front().view;
  return {newest.grid, newest.stamp_ns, pose_of(newest.T_odom_base)};
}

}  // namespace gvom
