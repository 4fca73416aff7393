// The pipeline without processes: sweeps of all lidars in order of their stamps, one map after each.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <tl/expected.hpp>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/ground_check.hpp"
#include "services/ingest/odometry_intake.hpp"
#include "services/ingest/source.hpp"

namespace gvom::tools {

/// What became of one sweep.
struct MappedSweep {
  std::string lidar;
  std::int64_t stamp_ns = 0;
  bool complete = true;
  FilterCounts filter;
};

/// A recording is not what it should be (bad_data), or a device is not there or was lost (unavailable).
struct OfflineError {
  services::ExitCode code;
  std::string what;
};

template <class T>
using OfflineExpected = tl::expected<T, OfflineError>;

/// What computes, and why and on what: for people.
struct BackendWords {
  std::string name;
  std::string details;
};

/// Maps of sweeps that the odometry had placed, and that the fused map did not take.
struct RefusedMaps {
  std::uint64_t too_old = 0;
  std::uint64_t duplicate = 0;
  std::uint64_t before_jump = 0;

  [[nodiscard]] std::uint64_t all() const { return too_old + duplicate + before_jump; }
};

/// A line for each reason.
std::vector<std::string> explain(const RefusedMaps& refused);

class OfflineMapper {
 public:
  /// Opens the source of every lidar that has one, and the back ends that the configuration asks for.
  /// `odometry`: see read_odometry_source, or `static` for a vehicle that stands at the origin. Without
  /// `deskew` all returns of a sweep take its stamp, to see what that costs. Errors say which file or back
  /// end and why.
  static OfflineExpected<OfflineMapper> open(const services::VehicleConfig& config,
                                             const std::string& odometry, bool deskew = true);

  /// Maps and fuses the next sweep in order of stamps (ties: by lidar name). Nothing at the end. Sweeps that
  /// the odometry cannot place are passed over and counted, by the code that ingest asks (R3). After a jump
  /// of the odometry the map begins anew. An error bad_data ends one lidar's recording: the sweeps before it
  /// were mapped. An error unavailable ends everything.
  OfflineExpected<bool> next(MappedSweep& mapped);

  /// Layers of what is fused so far.
  DeviceExpected<void> make_layers(const LayerArrays& out) { return fuser_->make_layers(out); }

  [[nodiscard]] MapFuser& fuser() { return *fuser_; }
  [[nodiscard]] const MapFuser& fuser() const { return *fuser_; }
  /// What a person should hear of the odometry.
  [[nodiscard]] const std::vector<std::string>& odometry_warnings() const { return warnings_; }
  [[nodiscard]] const BackendWords& fusion_backend() const { return fusion_backend_; }
  [[nodiscard]] const ingest::OdometryIntake& odometry() const { return *odometry_; }
  [[nodiscard]] std::uint64_t sweeps_without_odometry() const;  ///< Of all lidars.
  [[nodiscard]] std::uint64_t maps_refused() const;             ///< Likewise.

  struct Lidar {
    std::string name;
    std::unique_ptr<ingest::Source> source;
    std::unique_ptr<SweepMapper> mapper;
    BackendWords backend;
    Sweep sweep;  // the next one
    bool ended = false;
    ingest::SweepLosses losses;  // of sweeps that the odometry could not place; explain() has the words
    RefusedMaps refused;
    std::unique_ptr<ingest::GroundCheck> ground;
  };
  [[nodiscard]] const std::vector<Lidar>& lidars() const { return lidars_; }

 private:
  [[nodiscard]] std::optional<std::size_t> whose_turn() const;
  OfflineExpected<void> add_odometry(services::OdometryConfig config, const std::string& odometry);
  OfflineExpected<void> add_fusion(const services::VehicleConfig& config);
  OfflineExpected<void> add_lidar(const services::VehicleConfig& config, const services::LidarConfig& lidar);
  OfflineExpected<void> advance(Lidar& lidar);
  OfflineExpected<bool> map_sweep(std::size_t index, MappedSweep& mapped);
  OfflineExpected<bool> fuse(std::size_t index, std::unique_ptr<BrickMapStorage> map);

  std::vector<Lidar> lidars_;  // sorted by name
  std::unique_ptr<ingest::OdometryIntake> odometry_;
  std::vector<std::string> warnings_;                                           // of its file
  std::unordered_map<std::uint64_t, std::unique_ptr<BrickMapStorage>> window_;  // by token
  std::unique_ptr<MapFuser> fuser_;                                             // reads what the window holds
  BackendWords fusion_backend_;
  bool deskew_ = true;
  std::uint64_t next_token_ = 0;
  std::int64_t jump_ns_ = 0;           // the map began anew with the first sweep after it
  std::optional<OfflineError> error_;  // found while a sweep was read ahead; told after those before it
};

}  // namespace gvom::tools
