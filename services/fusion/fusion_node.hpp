// The one process that fuses: buffer maps of all lidars in, layers and fused voxels out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/mapper.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/fusion/map_inbox.hpp"

namespace gvom::fusion {

/// This process's ends of the topics.
struct Bus {
  ipc::Waiter waiter;
  MapInbox inbox;
  ipc::LayersPublisher layers;
  ipc::BrickMapPublisher voxels;
  ipc::Publisher<ipc::Progress> progress;
  ipc::Publisher<ipc::Health> health;

  static ipc::Expected<Bus> open(ipc::Runtime& runtime, const services::VehicleConfig& config);
};

/// What fusion counts, as Health tells it.
struct FusionCounters {
  explicit FusionCounters(services::HealthReport& health);

  std::uint64_t& maps_in;
  std::uint64_t& maps_fused;
  std::uint64_t& maps_lost;  // gaps in their sequences
  std::uint64_t& drop_map_too_old;
  std::uint64_t& drop_map_duplicate;
  std::uint64_t& drop_map_wrong_grid;
  std::uint64_t& drop_map_old_epoch;
  std::uint64_t& drop_map_refused;  // not readable: version, size
  std::uint64_t& layers_out;
  std::uint64_t& drop_layers_no_chunk;
  std::uint64_t& voxel_maps_out;
  std::uint64_t& drop_voxels_no_chunk;
  std::uint64_t& epochs;
  services::StageHistogram& fuse;
  services::StageHistogram& make_layers;
  services::StageHistogram& received_to_layers;
};

class FusionNode {
 public:
  /// All references outlive the node.
  FusionNode(const services::VehicleConfig& config, ipc::Runtime& runtime, Bus& bus,
             services::Lifecycle& lifecycle);
  ~FusionNode();

  /// Until a stop.
  services::ExitCode run();

 private:
  void fuse_arrived();
  void fuse(const ArrivedMap& map);
  void begin_epoch(std::uint64_t epoch);
  void count_refusal(AddResult result);
  void fail(const DeviceError& error);
  [[nodiscard]] bool tick_due(std::int64_t now_ns) const;
  void publish_layers();
  void fill_lidars(ipc::Layers& header) const;
  void publish_voxels();
  void publish_progress();
  void publish_health();

  const services::VehicleConfig& config_;
  Bus& bus_;
  services::Lifecycle& lifecycle_;
  services::BrokerWatch broker_;
  services::HealthReport health_;
  FusionCounters counters_;
  services::LogEvery log_drops_{std::chrono::seconds(10)};

  MapFuser fuser_;
  ipc::BrickMap newest_{};  // header of the newest map in the window, for its stage times
  std::uint64_t epoch_ = 0;
  std::int64_t fused_ns_ = 0;
  bool fresh_ = false;         // something was fused since the last layers
  bool voxels_fresh_ = false;  // layers were made since the last voxel map
  std::int64_t next_tick_ns_ = 0;
  std::int64_t next_voxels_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  std::int64_t last_layers_ns_ = 0;
  bool progress_news_ = true;
  std::string failure_;  // of the back end, for good
};

}  // namespace gvom::fusion
