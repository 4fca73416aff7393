// From the returns of a sweep to a buffer map (R2..R6) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/backend.hpp"
#include "core/cpu/ray_caster.hpp"

namespace gvom::cpu {

/// Returns that passed the filter, number by number: coordinates in the sensor's frame, height in odom,
/// metres.
struct ReturnBatch {
  double x[kRayBatch], y[kRayBatch], z[kRayBatch];
  float height_m[kRayBatch];
};

/// Counts one sweep in private memory, then writes it where the caller wants it. All memory is
/// allocated at construction.
class Voxelizer : public VoxelizerBackend {
 public:
  /// @param max_returns room for hits: the returns that a sweep can have
  Voxelizer(const MapConfig& map, const LidarGeometry& lidar, const VehicleGeometry& vehicle,
            std::size_t max_returns);

  DeviceExpected<BrickMapShape> count(const Sweep& sweep, const std::vector<Pose>& T_odom_base,
                                      const Grid& grid) override;
  /// Also clears the counters for the next sweep.
  DeviceExpected<void> write(const BrickMapArrays& out) override;
  [[nodiscard]] const FilterCounts& filter_counts() const override { return filter_counts_; }

 private:
  struct Hit {
    std::uint32_t hits;
    float min_height_m;
  };

  bool passes_filter(const Return& r);
  const Return* fill_batch(const Return* r, const Return* end);
  void add_hit(std::uint32_t index, float height_m);
  void find_touched_bricks(BrickMapShape& shape);
  std::uint32_t write_hits(const BrickMapArrays& out, std::uint32_t slot, std::int32_t* lookup,
                           std::uint32_t record);
  void write_lowest_rays(const BrickMapArrays& out);
  void forget();

  Eigen::Isometry3d T_base_sensor_;
  ReturnFilter filter_;
  std::uint32_t brick_slots_;
  Grid grid_;  // of the sweep
  PassCounters passes_;
  ReturnBatch batch_;
  RayEnds ends_;
  std::vector<std::uint32_t> hit_of_;  // per voxel, where kOccupied is set in its counter: index in hits_
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> bricks_;  // slots of the touched bricks, ascending
  FilterCounts filter_counts_;
};

}  // namespace gvom::cpu
