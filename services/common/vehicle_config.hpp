// One vehicle: what its YAML file says, as structs. Defaults live here and in core/config.hpp only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/backend.hpp"
#include "core/config.hpp"
#include "services/common/bridge_config.hpp"
#include "services/common/planner_config.hpp"

namespace gvom::services {

/// `T_base_sensor` as the file says it: R = Rz(yaw) Ry(pitch) Rx(roll), so `p_base = R p_sensor + (x, y, z)`.
/// Kept beside the transform that is made of it, so that it prints as it was read.
struct Extrinsic {
  double x_m = 0.0;  ///< Each -100 .. 100.
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_rad = 0.0;  ///< Each -6.2832 .. 6.2832.
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};

/// What a lidar's stamps are made of.
enum class LidarClock {
  sensor,   ///< The sensor's own, as its packets say.
  arrival,  ///< When its packets came, smoothed to the sensor's rate: Unix time.
};

/// One lidar, `lidars.NAME.*`.
struct LidarConfig {
  std::string name;        ///< The key under `lidars`: [a-z0-9_], at most 31 characters.
  std::string source;      ///< Source URI, e.g. `ouster-udp:7502?meta=FILE`; may be empty (given by --set).
  Extrinsic extrinsic;     ///< T_base_sensor.{x,y,z,roll,pitch,yaw}, all six required.
  LidarGeometry geometry;  ///< T_base_sensor (made of `extrinsic`), min_range_m, max_range_m.
  double min_sweep_fraction = 0.5;        ///< Sweeps with less of their columns are dropped, 0 .. 1.
  int max_returns = 262144;               ///< Room for one sweep; more are dropped and counted, 1 .. 4194304.
  LidarClock clock = LidarClock::sensor;  ///< `arrival` needs packets.
  double clock_offset_s = 0.0;            ///< Added to its stamps, -4e9 .. 4e9.
  Backend backend = Backend::cpu;  ///< What voxelizes. Each process on a GPU takes a context's memory there.
};

/// `odometry.*`.
struct OdometryConfig {
  std::string source;      ///< See read_odometry_source; may be empty (given on the command line).
  double timeout_s = 1.0;  ///< A live sweep waits this long for the odometry that brackets it, 0.01 .. 60.
  // The next two hold for recordings as well: gvom-map and a replay at any rate give the map that live
  // sensors would have given.
  double max_gap_s = 0.5;       ///< Between two poses; a sweep in a longer one is not mapped, 0.05 .. 60.
  double max_speed_mps = 40.0;  ///< Faster from pose to pose is a jump: the map begins anew, 1 .. 1000.
  double max_clock_offset_s =
      0.25;  ///< Live: farther apart, a lidar's clock is not odometry's, 0.05 .. 3600.
};

/// `fusion.*`.
struct FusionConfig {
  Backend backend = Backend::cpu;  ///< What fuses and makes the layers.
  double rate_hz = 0.0;            ///< Layers at this rate; 0: on each map, 0 .. 100.
  double voxel_rate_hz =
      2.0;  ///< VoxelMap at most this often, and only if somebody reads it; 0: never, 0 .. 100.
  double missing_after_s = 0.3;  ///< A lidar without a map newer than this before the newest, 0.05 .. 60.
};

/// `ipc.*`: sizes of the shared-memory pools.
struct IpcConfig {
  int max_planners = 4;  ///< Processes that read Layers or VoxelMap at the same time, 1 .. 32.
};

struct VehicleConfig {
  std::string path;     ///< The file this came from.
  std::string name;     ///< `name`: [a-z0-9_], at most 31 characters.
  MapperConfig mapper;  ///< Keys `map.*`, `window.*`, `vehicle.*`, `layers.*`, `cost.*`.
  FusionConfig fusion;
  IpcConfig ipc;
  OdometryConfig odometry;
  planner::PlannerConfig planner;   ///< Keys `planner.*`, and its `vehicle` the rest of `vehicle.*`.
  bridge::BridgeConfig bridge;      ///< Keys `bridge.*`.
  std::vector<LidarConfig> lidars;  ///< Sorted by name.
};

// The words of configuration and command line for a back end, a clock and a steering.

inline constexpr std::pair<std::string_view, Backend> kBackendWords[] = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"cuda", Backend::cuda}};

inline constexpr std::pair<std::string_view, LidarClock> kClockWords[] = {{"sensor", LidarClock::sensor},
                                                                          {"arrival", LidarClock::arrival}};

inline constexpr std::pair<std::string_view, planner::Steering> kSteeringWords[] = {
    {"ackermann", planner::Steering::ackermann}, {"skid_steer", planner::Steering::skid_steer}};

inline std::optional<Backend> backend_of(std::string_view word) {
  for (const auto& [known, backend] : kBackendWords)
    if (known == word) return backend;
  return std::nullopt;
}

inline std::string_view word_of(Backend backend) {
  for (const auto& [word, known] : kBackendWords)
    if (known == backend) return word;
  return {};
}

}  // namespace gvom::services
