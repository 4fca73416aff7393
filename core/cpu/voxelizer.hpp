// From the returns of a sweep to a buffer map (R2..R6) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/brick_map.hpp"
#include "core/config.hpp"
#include "core/cpu/ray_caster.hpp"
#include "core/sweep.hpp"

namespace gvom::cpu {

/// What the filter (R2) did with a sweep's returns.
struct FilterCounts {
  std::uint64_t used = 0;
  std::uint64_t not_finite = 0;
  std::uint64_t too_near = 0;
  std::uint64_t too_far = 0;
  std::uint64_t body = 0;
};

/// Returns that passed the filter, number by number: coordinates in the sensor's frame, height in odom,
/// metres.
struct ReturnBatch {
  double x[kRayBatch], y[kRayBatch], z[kRayBatch];
  float height_m[kRayBatch];
};

/// Counts one sweep in private memory, then writes it where the caller wants it. All memory is
/// allocated at construction.
class Voxelizer {
 public:
  /// @param max_returns room for hits: the returns that a sweep can have
  Voxelizer(const MapConfig& map, const LidarGeometry& lidar, const VehicleGeometry& vehicle,
            std::size_t max_returns);

  /// Counts hits and passes of a sweep (R2..R5); returns the room that its map takes. A map that was
  /// counted and not written is forgotten.
  /// @param T_odom_base one pose for each of `sweep.times_ns`
  BrickMapShape count(const Sweep& sweep, const std::vector<Pose>& T_odom_base, const Grid& grid);

  /// Writes the counted map (R6) and clears the counters for the next.
  /// @param out arrays of at least the counted shape; every element of that shape is written
  void write(const BrickMapArrays& out);

  [[nodiscard]] const FilterCounts& filter_counts() const { return filter_counts_; }

 private:
  struct Hit {
    std::uint32_t hits;
    float min_height_m;
  };

  bool passes_filter(const Return& r, FilterCounts& counts) const;
  const Return* fill_batch(const Return* r, const Return* end);
  void add_hit(std::uint32_t index, float height_m);
  void find_touched_bricks(BrickMapShape& shape);
  std::uint32_t write_hits(const BrickMapArrays& out, std::uint32_t slot, std::int32_t* lookup,
                           std::uint32_t record);
  void forget();

  LidarGeometry lidar_;
  VehicleGeometry vehicle_;
  std::uint32_t brick_slots_;
  PassCounters passes_;
  ReturnBatch batch_;
  RayEnds ends_;
  std::vector<std::uint32_t> hit_of_;  // per voxel, where kOccupied is set in its counter: index in hits_
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> bricks_;  // slots of the touched bricks, ascending
  FilterCounts filter_counts_;
};

}  // namespace gvom::cpu
