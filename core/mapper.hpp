// The whole pipeline on one page: sweeps and odometry in, layers out. Processes run its two halves on
// either side of the shared memory; gvom-map runs both in one.
#pragma once

#include <optional>
#include <vector>

#include "core/brick_map.hpp"
#include "core/config.hpp"
#include "core/cpu/fused_map.hpp"
#include "core/cpu/layer_maker.hpp"
#include "core/cpu/voxelizer.hpp"
#include "core/layers.hpp"
#include "core/odometry_buffer.hpp"
#include "core/sweep.hpp"

namespace gvom {

/// Half one, for one lidar: a sweep becomes a buffer map (R1..R6).
class SweepMapper {
 public:
  SweepMapper(const MapperConfig& config, const LidarGeometry& lidar, std::size_t max_returns)
      : map_(config.map), voxelizer_(config.map, lidar, config.vehicle, max_returns) {}

  /// Whether the odometry reaches the sweep's stamp; before, the sweep has to wait (R3).
  static bool is_due(const Sweep& sweep, const OdometryBuffer& odometry) {
    return !odometry.empty() && odometry.newest_ns() >= sweep.stamp_ns;
  }

  /// Counts a sweep: what its map needs to be written. Nothing if the odometry does not bracket all of
  /// the sweep's times: there is no extrapolation (R3).
  std::optional<BrickMapShape> count(const Sweep& sweep, const OdometryBuffer& odometry) {
    const std::optional<Pose> at_stamp = odometry.at(sweep.stamp_ns);
    if (!at_stamp || !find_poses(sweep, odometry)) return std::nullopt;
    T_odom_base_ = *at_stamp;
    grid_ = grid_around(map_, T_odom_base_.translation_m);
    return voxelizer_.count(sweep, poses_, grid_);
  }

  /// Writes the counted map, usually straight into shared memory (R6).
  void write(const BrickMapArrays& out) { voxelizer_.write(out); }

  /// Of the counted sweep: grid, pose at the stamp, what the filter dropped (R2).
  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const Pose& T_odom_base() const { return T_odom_base_; }
  [[nodiscard]] const cpu::FilterCounts& filter_counts() const { return voxelizer_.filter_counts(); }

 private:
  bool find_poses(const Sweep& sweep, const OdometryBuffer& odometry) {
    poses_.clear();
    for (const std::int64_t time_ns : sweep.times_ns) {
      const std::optional<Pose> pose = odometry.at(time_ns);
      if (!pose) return false;
      poses_.push_back(*pose);
    }
    return true;
  }

  MapConfig map_;
  cpu::Voxelizer voxelizer_;
  std::vector<Pose> poses_;  // one for each time of the sweep: deskewing
  Grid grid_;
  Pose T_odom_base_;
};

/// Half two, for all lidars: buffer maps become the fused map and its layers (R7..R16).
class MapFuser {
 public:
  explicit MapFuser(const MapperConfig& config)
      : fused_(config.map, config.window, config.layers.min_hits), layer_maker_(config) {}

  /// Fuses a map (R7, R8); see FusedMap::add on how long its memory must stay.
  AddResult add(const WindowMap& map) { return fused_.add(map); }

  /// The newest map's moment, which the layers are of. The window must not be empty.
  [[nodiscard]] LayerMoment moment() const {
    const BrickMapView& newest = fused_.window().maps().front().view;
    return {newest.grid, newest.stamp_ns, newest.T_odom_base};
  }

  /// Writes all layers (R9..R16). The window must not be empty.
  void make_layers(const LayerArrays& out) { layer_maker_.make(fused_.view(), moment(), out); }

  /// Forgets everything, as when the clock of a replay starts again.
  void reset() { fused_.reset(); }

  [[nodiscard]] const cpu::FusedMap& fused() const { return fused_; }

 private:
  cpu::FusedMap fused_;
  cpu::LayerMaker layer_maker_;
};

}  // namespace gvom
