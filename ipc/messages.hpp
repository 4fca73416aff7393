// What travels between the processes: fixed-layout structs without pointers. Each starts with a
// MessageHeader; a message whose type, version or size is not the reader's own is refused, not read.
// Times named *_ns without "mono" are the sensors' clock; mono_*_ns are CLOCK_MONOTONIC of this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/format/brick_map.hpp"
#include "core/format/grid.hpp"
#include "core/format/layers.hpp"

namespace gvom::ipc {

inline constexpr std::uint32_t kMagic = 0x4D4F5647;  // "GVOM"
inline constexpr std::size_t kNameLength = 32;       // with the terminating zero

enum class MessageType : std::uint16_t {
  odometry = 1,
  buffer_map,
  layers,
  voxel_map,
  health,
  progress,
  course,
  plan,
  command
};

struct MessageHeader {
  std::uint32_t magic;
  std::uint16_t type;      // MessageType
  std::uint16_t version;   // of the message's layout, see `kVersion` in each struct
  std::uint64_t size;      // header and arrays, bytes
  std::uint64_t sequence;  // counts the publisher's messages of this type from 1: a gap is a loss
  std::int64_t stamp_ns;   // the data's time
  std::uint64_t epoch;     // raised when the odometry's clock starts again (a looped replay); windows reset
};

/// Topic "odometry": the pose at `header.stamp_ns`.
struct Odometry {
  static constexpr MessageType kType = MessageType::odometry;
  static constexpr std::uint16_t kVersion = 1;
  enum Flags : std::uint32_t {
    kLossless = 1,     // the replay waits for its readers; they wait for theirs, nothing may be dropped
    kEndOfStream = 2,  // nothing follows in this epoch; the pose repeats the last one
  };
  MessageHeader header;
  PoseRecord T_odom_base;
  std::uint32_t flags;
  std::uint32_t reserved;
};

/// What an ingest makes of the ground around the vehicle.
enum class GroundVerdict : std::uint32_t { none = 0, not_judged = 1, well = 2, wrong = 3 };

/// The ground as one lidar sees it, held against where T_base_sensor and vehicle.base_height_m put it.
struct Ground {
  std::uint32_t verdict;  // GroundVerdict; none of a process without a lidar
  std::uint32_t sweeps;   // that it is the median of; 0: the numbers below say nothing
  float expected_z_m;     // where it should be in base_link: -base_height_m
  float height_m;         // above that, at base_link's origin
  float slope_x;          // of the ground in base_link, m/m
  float slope_y;
  std::uint32_t on_the_way;  // 1 if the vehicle went on for some metres in these sweeps, so that slopes pass
  std::uint32_t reserved;
};

/// Voxels of a grid in bricks of 8 x 8 x 8 (R6): the header, then the arrays of BrickMapArrays as
/// `brick_map_layout` has them. Topic "buffer_map" (one sweep of one lidar) and "voxel_map" (the fused map:
/// counts summed over the window).
struct BrickMap {
  static constexpr std::uint16_t kVersion = 4;
  enum Flags : std::uint32_t {
    kLossless = 1,  // of a replay that waits for its readers: fusion makes layers of each map
  };
  MessageHeader header;
  char lidar[kNameLength];  // empty in a voxel map
  Grid grid;
  PoseRecord T_odom_base;  // at the stamp
  BrickMapShape shape;
  float columns_seen_fraction;       // of the sweep's columns, 0 .. 1; 1: it is complete
  std::uint32_t flags;               // Flags
  Ground ground;                     // of the sweeps before this one; verdict none in a voxel map
  std::uint64_t returns;             // that became hits or rays
  std::uint64_t dropped_not_finite;  // returns dropped by the filter (R2), this sweep
  std::uint64_t dropped_too_near;
  std::uint64_t dropped_too_far;
  std::uint64_t dropped_body;
  std::int64_t mono_received_ns;  // last packet read, in a replay the odometry that reached the sweep's end
  std::int64_t suspended_ns;      // how long the machine had been suspended until then: CLOCK_MONOTONIC
                                  // stands still meanwhile, and an age must not
  std::int64_t mono_mapped_ns;    // odometry there, mapping began
  std::int64_t mono_published_ns;
  std::int64_t
      odometry_jump_ns;  // stamp of the first pose after the odometry's last jump in this epoch, 0: none
                         // seen. Maps from before it lie wrongly to those after. Not in a voxel map
};

/// What the window holds of one lidar.
struct LidarStatus {
  char name[kNameLength];
  std::int64_t newest_stamp_ns;  // 0: none came yet
  std::uint32_t maps_in_window;
  std::uint32_t missing;  // 1: one of the vehicle's lidars, but no map of it is in the window, or its newest
                          // is more than fusion.missing_after_s (0.3 s) older than the newest of all lidars,
                          // by their stamps. If all fall silent at once none is: then the layers' age says so
  std::uint64_t maps_received;
  std::uint64_t maps_lost;      // gaps in its sequence
  float columns_seen_fraction;  // of the columns of its newest sweep, 0 .. 1; 1: complete. 0: none came yet
  std::uint32_t unknown;        // 1: it publishes maps, but fusion's configuration does not have it: it is
                                // missing, and its maps are never taken
  Ground ground;                // as its newest map says
};

/// Topic "layers": the header, then 13 arrays of n_xy * n_xy values indexed [y][x], in the order of
/// LayerId, each aligned to 64 bytes. Unknown is NaN in float layers (R9..R16).
struct Layers {
  static constexpr MessageType kType = MessageType::layers;
  static constexpr std::uint16_t kVersion = 2;
  MessageHeader header;
  Grid grid;               // its origin is the world voxel of column (0, 0) and of the floor
  PoseRecord T_odom_base;  // at the stamp
  std::uint32_t maps_in_window;
  std::uint32_t lidar_count;
  LidarStatus lidars[kMaxLidars];
  std::int64_t mono_received_ns;  // stage times of the map whose packets came last of all in the window
  std::int64_t mono_mapped_ns;
  std::int64_t mono_map_published_ns;
  std::int64_t mono_fused_ns;
  std::int64_t mono_published_ns;
  std::int64_t suspended_ns;  // of that map
};

/// Topic "progress": what a reader has finished, so that a lossless replay can wait for it.
/// The header's epoch is that of the odometry it speaks of, 0 before the first: numbers of another epoch are
/// stale.
struct Progress {
  static constexpr MessageType kType = MessageType::progress;
  static constexpr std::uint16_t kVersion = 1;
  MessageHeader header;             // stamp_ns: of the data that was finished
  char reader[kNameLength];         // "fusion" or a lidar's name
  std::uint64_t odometry_sequence;  // ingest: every odometry up to this one was used, its sweeps published
  std::uint64_t maps_published;     // ingest: buffer maps published so far
  std::uint32_t lidar_count;        // fusion: per lidar, how many maps were taken (fused or refused)
  std::uint32_t reserved;
  struct Taken {
    char lidar[kNameLength];
    std::uint64_t sequence;  // highest BufferMap sequence taken
  } taken[kMaxLidars];
};

/// Topic "course": places in odom to drive to, one after the other. A new one replaces the one before; one
/// without places ends it.
struct Course {
  static constexpr MessageType kType = MessageType::course;
  static constexpr std::uint16_t kVersion = 1;
  static constexpr std::uint32_t kMaxPlaces = 256;
  MessageHeader header;
  std::uint32_t count;
  std::uint32_t reserved;
  struct Place {
    double x_m, y_m;
  } places[kMaxPlaces];
};

/// Topic "plan": what a planner means to do, for those who watch.
struct Plan {
  static constexpr MessageType kType = MessageType::plan;
  static constexpr std::uint16_t kVersion = 1;
  static constexpr std::uint32_t kMaxPoints = 256;
  struct Point {
    double x_m, y_m;  // of base_link in odom
    float z_m, yaw_rad;
    float curvature_per_m;  // from here on; positive: to the left
    float speed_mps;        // that may be driven here; negative: backwards
  };
  MessageHeader header;  // stamp_ns: of the pose that it begins at
  std::uint32_t mode;    // PlanMode
  std::uint32_t reason;  // the planner's own number; `why` says it in words
  char why[160];
  std::uint32_t waypoint;  // of the course, that it drives to
  std::uint32_t waypoints;
  double goal_x_m, goal_y_m;  // that waypoint
  double cost_to_go;          // from here to it; +infinity: no way
  double seen_m;              // ground along the trajectory that is known
  double layers_age_s;        // of the data, when the cycle began
  std::int64_t mono_begun_ns;
  std::int64_t mono_published_ns;
  std::uint32_t path_count;        // the way to the goal, as far as it was made drivable
  std::uint32_t trajectory_count;  // what it drives
  Point path[kMaxPoints];
  Point trajectory[kMaxPoints];
};

enum class PlanMode : std::uint32_t { drive = 0, creep = 1, back = 2, stop = 3, arrived = 4, gave_up = 5 };

/// Topic "command": what the vehicle is to do now. Whoever moves it brings it to a stand when the deadline
/// has passed and no newer command came: then the planner is dead, or late.
struct Command {
  static constexpr MessageType kType = MessageType::command;
  static constexpr std::uint16_t kVersion = 1;
  MessageHeader header;  // stamp_ns: of the pose that it was made for
  double speed_mps;      // negative: backwards
  double curvature_per_m;
  std::int64_t mono_deadline_ns;
  std::uint32_t mode;  // PlanMode
  std::uint32_t reserved;
};

enum class HealthState : std::uint32_t { starting = 0, ok = 1, degraded = 2, failed = 3, stopping = 4 };

/// Topic "health", at 1 Hz from every process.
struct Health {
  static constexpr MessageType kType = MessageType::health;
  static constexpr std::uint16_t kVersion = 3;
  static constexpr int kMaxCounters = 56;
  static constexpr int kMaxStages = 8;
  MessageHeader header;
  char process[2 * kNameLength];  // runtime name, e.g. "gvom-ingest-top"
  std::uint32_t state;            // HealthState
  std::uint32_t pid;
  char version[16];           // of gvom, e.g. "0.3.0"
  std::uint64_t config_hash;  // of its configuration as resolved: FNV-1a, 64 bits, over what --print-config
                              // prints
  char reason[256];           // why it is not ok, in words
  char backend[32];           // "cpu" or "cuda"; empty where there is none
  char backend_details[160];  // why this one, on what it runs, how it reaches the payloads: in words
  double rate_hz;             // of its product over the last second
  std::int64_t mono_ns;
  Ground ground;
  struct Counter {
    char name[kNameLength];
    std::uint64_t value;
  } counters[kMaxCounters];
  struct Stage {  // time per sweep or tick since the last message
    char name[kNameLength];
    double p50_ms, p99_ms, max_ms;
  } stages[kMaxStages];
  std::uint32_t counter_count;
  std::uint32_t stage_count;
};

static_assert(std::is_trivially_copyable_v<Odometry> && std::is_standard_layout_v<Odometry>);
static_assert(std::is_trivially_copyable_v<BrickMap> && std::is_standard_layout_v<BrickMap>);
static_assert(std::is_trivially_copyable_v<Layers> && std::is_standard_layout_v<Layers>);
static_assert(std::is_trivially_copyable_v<Progress> && std::is_standard_layout_v<Progress>);
static_assert(std::is_trivially_copyable_v<Course> && std::is_standard_layout_v<Course>);
static_assert(std::is_trivially_copyable_v<Plan> && std::is_standard_layout_v<Plan>);
static_assert(std::is_trivially_copyable_v<Command> && std::is_standard_layout_v<Command>);
static_assert(std::is_trivially_copyable_v<Health> && std::is_standard_layout_v<Health>);

}  // namespace gvom::ipc
