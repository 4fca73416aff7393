// The one process that fuses: buffer maps of all lidars in, layers and fused voxels out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/mapper.hpp"
#include "core/open_backend.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/device_trust.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/fusion/fusion_counters.hpp"
#include "services/fusion/lateness.hpp"
#include "services/fusion/map_inbox.hpp"
#include "services/fusion/map_trust.hpp"
#include "services/fusion/unknown_lidars.hpp"

namespace gvom::fusion {

/// This process's ends of the topics.
struct Bus {
  ipc::Waiter waiter;
  MapInbox inbox;
  ipc::InPort odometry;                   // the newest alone: what maps can be believed by
  ipc::Subscriber<ipc::Progress> others;  // who else runs
  ipc::LayersPublisher layers;
  ipc::BrickMapPublisher voxels;
  ipc::Publisher<ipc::Progress> progress;
  ipc::Publisher<ipc::Health> health;

  static ipc::Expected<Bus> open(ipc::Runtime& runtime, const services::VehicleConfig& config);
};

class FusionNode {
 public:
  /// All references outlive the node. The back end reads maps where the bus holds them: it goes with the
  /// node.
  FusionNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
             services::Lifecycle& lifecycle, const services::DeviceTrust& trust,
             OpenBackend<FusionBackend> backend);
  ~FusionNode();

  /// Until a stop (ok), or the back end fails (try_again): nothing that it made since goes out.
  services::ExitCode run();

 private:
  /// Fuses what is there, then makes layers, once: a backlog of maps is caught up with, not shown map by map.
  void fuse_arrived();
  void hear_others();
  void fuse(const ArrivedMap& map);
  bool place_in_time(const ipc::BrickMap& header);
  void begin_epoch(std::uint64_t epoch);
  void begin_after_jump(std::int64_t stamp_ns);
  void empty_window();
  /// For the arrays of a map, or its header: nothing of it is believed.
  template <typename Part>
  void refuse(const ArrivedMap& map, Part part, const std::string& why);
  void refuse(const ArrivedMap& map, AddResult result);
  /// In the log now, and in Health for two seconds.
  void complain(std::string why);
  /// Nothing of this process's map can be trusted any more: it leaves, to be started again.
  void fail(const DeviceError& error);
  [[nodiscard]] bool layers_due() const;
  void publish_layers();
  /// Of the map in the window whose packets came last.
  [[nodiscard]] const ipc::BrickMap& last_received() const;
  void record_costs();
  void fill_lidars(ipc::Layers& header) const;
  void publish_voxels();
  void publish_progress();
  void publish_health();
  void judge();
  void send_health(std::int64_t now_ns);

  const services::VehicleConfig& config_;
  Bus& bus_;
  services::Lifecycle& lifecycle_;
  const services::DeviceTrust& device_;
  services::BrokerWatch broker_;
  services::HealthReport health_;
  FusionCounters counters_;
  std::optional<DeviceStages> device_stages_;  // if a device fuses
  services::LogEvery log_drops_{std::chrono::seconds(10)};

  MapFuser fuser_;
  MapTrust trust_;
  UnknownLidars unknown_;
  Lateness lateness_;
  std::int64_t newest_stamp_ns_ = 0;  // of the window
  std::uint64_t epoch_ = 0;
  std::int64_t jump_ns_ = 0;  // of this epoch: no map from before the odometry's last jump is of use
  std::int64_t fused_ns_ = 0;
  bool fresh_ = false;         // something was fused since the last layers
  bool voxels_fresh_ = false;  // layers were made since the last voxel map
  std::int64_t next_tick_ns_ = 0;
  std::int64_t next_voxels_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  std::int64_t last_layers_ns_ = 0;
  bool progress_news_ = true;
  std::string complaint_;               // whose map was refused, and why
  std::int64_t complaint_ns_ = 0;       // when the last such came, 0: none yet
  std::optional<std::string> failure_;  // of the back end, for good
};

}  // namespace gvom::fusion
