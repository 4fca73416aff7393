// One lidar's process: sweeps wait for the odometry that brackets them, become buffer maps and go out.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/device_trust.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/fusion_credit.hpp"
#include "services/ingest/ground_check.hpp"
#include "services/ingest/ingest_counters.hpp"
#include "services/ingest/odometry_intake.hpp"
#include "services/ingest/sensor_watch.hpp"
#include "services/ingest/sweep_reader.hpp"

namespace gvom::ingest {

/// This process's ends of the topics.
struct Bus {
  ipc::Subscriber<ipc::Odometry> odometry;
  ipc::Subscriber<ipc::Progress> progress;
  ipc::BrickMapPublisher maps;
  ipc::Publisher<ipc::Progress> own_progress;
  ipc::Publisher<ipc::Health> health;
  ipc::Waiter waiter;

  static ipc::Expected<Bus> open(ipc::Runtime& runtime, const services::VehicleConfig& config,
                                 const std::string& lidar);
};

/// What was opened for the lidar: where its sweeps come from and what voxelizes them. `trust` outlives the
/// node.
struct Equipment {
  std::unique_ptr<Source> source;
  const services::DeviceTrust& trust;
  OpenBackend<VoxelizerBackend> backend;
};

class IngestNode {
 public:
  /// All references outlive the node. `lidar` is one of `config.lidars`.
  IngestNode(const services::VehicleConfig& config, const services::LidarConfig& lidar, ipc::Runtime& runtime,
             Bus& bus, services::Lifecycle& lifecycle, Equipment equipment);
  ~IngestNode();

  /// Until a stop (ok), the source breaks (bad_data for a recording, unavailable for a sensor), or the back
  /// end fails (try_again).
  services::ExitCode run();

 private:
  void take_odometry();
  void take_refusals();
  void begin_epoch();
  void say(Taken taken, std::uint64_t sequence);
  /// The oldest sweep, which is ours until it is mapped or dropped; null if there is none.
  Sweep* front();
  void release_front();
  /// Maps every sweep that the odometry has reached; false while one waits for room at fusion.
  bool map_due_sweeps();
  void drop(const Sweep& sweep, SweepLoss why);
  void map_sweep(const Sweep& sweep);
  bool publish(const Sweep& sweep, const BrickMapShape& shape, std::int64_t begin_ns);
  /// The back end is lost for good, and the sweep in hand with it: this process leaves, to be started again.
  void fail(const SweepError& error);
  /// Whether nothing more can come of the odometry so far.
  [[nodiscard]] bool is_settled();
  [[nodiscard]] std::int64_t odometry_stamp_ns() const;
  void publish_progress();
  void publish_health();
  /// The state for Health, in words where it is not ok. Returns the faults that it names.
  std::uint64_t judge(std::int64_t now_ns);
  void send_health(std::int64_t now_ns);
  /// Why no sweep was mapped so far.
  void describe_start(services::Words& words) const;

  const services::LidarConfig& lidar_;
  Bus& bus_;
  services::Lifecycle& lifecycle_;
  const services::DeviceTrust& device_;
  services::BrokerWatch broker_;
  services::HealthReport health_;
  IngestCounters counters_;
  services::LogEvery log_drops_{std::chrono::seconds(10)};

  SweepMapper mapper_;
  FusionCredit credit_;
  SweepReader reader_;
  OdometryIntake odometry_;
  GroundCheck ground_;
  SensorWatch sensor_watch_;
  SweepLosses losses_;

  std::uint64_t odometry_sequence_ = 0;      // newest received
  std::uint64_t acknowledged_sequence_ = 0;  // newest of which all sweeps were mapped
  bool lossless_ = false;
  Sweep* front_ = nullptr;
  std::int64_t front_since_ns_ = 0;  // CLOCK_MONOTONIC since when it is there
  std::int64_t next_progress_ns_ = 0;
  std::uint64_t told_odometry_ = 0;
  std::uint64_t told_maps_ = 0;
  std::int64_t last_map_ns_ = 0;
  std::uint64_t told_faults_ = 0;  // in the last Health
  std::int64_t told_health_ns_ = 0;
  std::optional<std::string> failure_;  // of the back end, for good
};

}  // namespace gvom::ingest
