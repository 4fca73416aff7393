// The pipeline without processes: sweeps of all lidars in order of their stamps, one map after each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <tl/expected.hpp>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/source.hpp"

namespace gvom::tools {

/// What became of one sweep.
struct MappedSweep {
  std::string lidar;
  std::int64_t stamp_ns = 0;
  bool complete = true;
  FilterCounts filter;
};

class OfflineMapper {
 public:
  /// Opens the source of every lidar that has one. `odometry`: `tum:FILE`, or `static` for a vehicle that
  /// stands at the origin. Without `deskew` all returns of a sweep take its stamp, to see what that costs.
  /// Errors say which file and why.
  static tl::expected<OfflineMapper, std::string> open(const services::VehicleConfig& config,
                                                       const std::string& odometry, bool deskew = true);

  /// Maps and fuses the next sweep in order of stamps (ties: by lidar name). Nothing at the end. Sweeps that
  /// the odometry does not bracket are passed over and counted (R3). An error ends one lidar's recording: the
  /// sweeps before it were mapped.
  tl::expected<bool, std::string> next(MappedSweep& mapped);

  /// Layers of what is fused so far.
  DeviceExpected<void> make_layers(const LayerArrays& out) { return fuser_->make_layers(out); }

  [[nodiscard]] MapFuser& fuser() { return *fuser_; }
  [[nodiscard]] const MapFuser& fuser() const { return *fuser_; }
  [[nodiscard]] std::uint64_t sweeps_without_odometry() const { return without_odometry_; }
  [[nodiscard]] std::uint64_t maps_refused() const { return refused_; }

  struct Lidar {
    std::string name;
    std::unique_ptr<ingest::Source> source;
    std::unique_ptr<SweepMapper> mapper;
    Sweep sweep;  // the next one
    bool ended = false;
  };
  [[nodiscard]] const std::vector<Lidar>& lidars() const { return lidars_; }

 private:
  tl::expected<void, std::string> add_odometry(const std::string& odometry);
  tl::expected<void, std::string> add_lidar(const services::VehicleConfig& config,
                                            const services::LidarConfig& lidar);
  tl::expected<void, std::string> advance(Lidar& lidar);
  bool map_sweep(std::size_t index, MappedSweep& mapped);

  std::vector<Lidar> lidars_;  // sorted by name
  std::unique_ptr<OdometryBuffer> odometry_;
  std::unique_ptr<MapFuser> fuser_;
  std::unordered_map<std::uint64_t, std::unique_ptr<BrickMapStorage>> window_;  // by token
  bool deskew_ = true;
  std::uint64_t next_token_ = 0;
  std::uint64_t without_odometry_ = 0;
  std::uint64_t refused_ = 0;
  std::string error_;  // found while a sweep was read ahead; told after the sweeps before it
};

}  // namespace gvom::tools
