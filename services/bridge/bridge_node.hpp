// The process's loop: what comes on the bus goes to the sinks that want it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/bridge/bridge_bus.hpp"
#include "services/bridge/message_maker.hpp"
#include "services/bridge/sink.hpp"
#include "services/bridge/status.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/health.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::bridge {

using Sinks = std::vector<std::unique_ptr<Sink>>;

/// Reads as a planner does: the newest, never a queue of old ones. A message is made once, only if a sink
/// wants it, and the chunk that it is made of goes back at once. Nothing here waits for a sink, and nobody on
/// the bus for the bridge.
class BridgeNode {
 public:
  /// All references outlive the node.
  BridgeNode(const services::VehicleConfig& config, MessageSettings settings, Bus& bus, const Sinks& sinks,
             services::Lifecycle& lifecycle);
  ~BridgeNode();

  /// Until a stop.
  services::ExitCode run();

 private:
  /// Of one sink, in Health.
  struct SinkReport {
    const Sink& sink;
    std::array<std::uint64_t*, 6> counters;
    std::string told_problem;  // in the log
  };

  [[nodiscard]] bool wanted(TopicId id) const;
  void send(TopicId id, std::int64_t stamp_ns, const ros::Blob& message);
  void take_odometry();
  void take_layers();
  void send_layers(const ipc::LayersSample& sample);
  void join_or_leave_voxels();
  void take_voxels();
  void take_plan();
  void take_health();
  void tell_each_second();
  void tell_sinks();
  void publish_health(std::int64_t now_ns);

  const services::VehicleConfig& config_;
  Bus& bus_;
  const Sinks& sinks_;
  services::Lifecycle& lifecycle_;
  services::BrokerWatch broker_;
  services::HealthReport health_;
  services::StageHistogram& write_stage_;  // layers to messages
  std::uint64_t &layers_in_, &layers_skipped_, &layers_lost_, &voxels_in_, &plans_in_, &odometry_in_;
  std::uint64_t &bad_voxels_, &refused_;
  services::LogEvery log_drops_{std::chrono::seconds(10)};
  std::vector<SinkReport> reports_;

  MessageMaker maker_;
  Heard heard_;
  std::int64_t data_stamp_ns_ = 0;  // the newest
  std::int64_t data_came_ns_ = 0;   // when it came
  std::int64_t next_layers_ns_ = 0;
  std::int64_t next_tf_ns_ = 0;
  std::int64_t next_second_ns_ = 0;
  std::int64_t voxels_wanted_ns_ = 0;  // when they were last
};

}  // namespace gvom::bridge
