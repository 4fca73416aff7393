// The whole pipeline on one page: sweeps and odometry in, layers out. Processes run its two halves on
// either side of the shared memory; gvom-map runs both in one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/backend.hpp"
#include "core/config.hpp"
#include "core/cpu/fusion.hpp"
#include "core/cpu/voxelizer.hpp"
#include "core/odometry_buffer.hpp"

namespace gvom {

/// Why a sweep was not counted.
struct SweepError {
  enum class Reason { no_odometry, device };
  Reason reason;
  std::string what;
};

/// Half one, for one lidar: a sweep becomes a buffer map (R1..R6).
class SweepMapper {
 public:
  SweepMapper(const MapConfig& map, std::unique_ptr<VoxelizerBackend> backend)
      : map_(map), backend_(std::move(backend)) {}
  /// On the CPU.
  SweepMapper(const MapperConfig& config, const LidarGeometry& lidar, std::size_t max_returns)
      : SweepMapper(config.map,
                    std::make_unique<cpu::Voxelizer>(config.map, lidar, config.vehicle, max_returns)) {}

  /// Counts a sweep: what its map needs to be written. Error `no_odometry` if the odometry does not cover
  /// `span_of(sweep)`: there is no extrapolation (R3).
  tl::expected<BrickMapShape, SweepError> count(const Sweep& sweep, const OdometryBuffer& odometry) {
    const std::optional<Pose> at_stamp = odometry.at(sweep.stamp_ns);
    if (!at_stamp || odometry.reach(span_of(sweep)) != Reach::covered)
      return tl::unexpected(
          SweepError{SweepError::Reason::no_odometry, "the odometry does not cover the sweep"});
    find_poses(sweep, odometry, *at_stamp);
    T_odom_base_ = *at_stamp;
    grid_ = grid_around(map_, T_odom_base_.translation_m);
    auto shape = backend_->count(sweep, poses_, grid_);
    if (!shape) return tl::unexpected(SweepError{SweepError::Reason::device, shape.error().what});
    return *shape;
  }

  /// Writes the counted map, usually straight into shared memory (R6).
  DeviceExpected<void> write(const BrickMapArrays& out) { return backend_->write(out); }

  /// Of the counted sweep: grid, pose at the stamp, what the filter dropped (R2).
  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const Pose& T_odom_base() const { return T_odom_base_; }
  [[nodiscard]] const FilterCounts& filter_counts() const { return backend_->filter_counts(); }

 private:
  // Times without a return may lie beyond the odometry. Nobody reads their poses.
  void find_poses(const Sweep& sweep, const OdometryBuffer& odometry, const Pose& at_stamp) {
    poses_.clear();
    for (const std::int64_t time_ns : sweep.times_ns)
      poses_.push_back(odometry.at(time_ns).value_or(at_stamp));
  }

  MapConfig map_;
  std::unique_ptr<VoxelizerBackend> backend_;
  std::vector<Pose> poses_;  // one for each time of the sweep: deskewing
  Grid grid_;
  Pose T_odom_base_;
};

/// Half two, for all lidars: buffer maps become the fused map and its layers (R7..R16).
class MapFuser {
 public:
  explicit MapFuser(std::unique_ptr<FusionBackend> backend) : backend_(std::move(backend)) {}
  /// On the CPU.
  explicit MapFuser(const MapperConfig& config) : MapFuser(std::make_unique<cpu::Fusion>(config)) {}

  /// Fuses a map (R7, R8); see FusionBackend::add on how long its memory must stay.
  DeviceExpected<AddResult> add(const WindowMap& map) { return backend_->add(map); }

  /// The newest map's moment, which the layers are of. The window must not be empty.
  [[nodiscard]] LayerMoment moment() const { return newest_moment(window()); }

  /// Writes all layers (R9..R16). The window must not be empty.
  DeviceExpected<void> make_layers(const LayerArrays& out) { return backend_->make_layers(out); }

  /// The fused voxels as a brick map (R6): the room it takes, then the writing of it.
  DeviceExpected<BrickMapShape> count_voxels() { return backend_->count_voxels(); }
  DeviceExpected<void> write_voxels(const BrickMapArrays& out) { return backend_->write_voxels(out); }

  /// Forgets everything, as when the clock of a replay starts again.
  void reset() { backend_->reset(); }

  [[nodiscard]] const Window& window() const { return backend_->window(); }
  [[nodiscard]] const FusionBackend& backend() const { return *backend_; }

 private:
  std::unique_ptr<FusionBackend> backend_;
};

}  // namespace gvom
