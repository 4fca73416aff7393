// One drive in real time through the real processes: this is the vehicle, its lidars and its odometry.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "ipc/layers.hpp"
#include "services/common/lifecycle.hpp"
#include "tools/drive/cli/session.hpp"
#include "tools/drive/live/course_talk.hpp"
#include "tools/drive/live/lidar_stream.hpp"
#include "tools/drive/live/live_vehicle.hpp"

namespace gvom::driving {

/// Its ends of the topics.
struct LiveBus {
  VehicleBus vehicle;
  ipc::Publisher<ipc::Course> course;
  ipc::Subscriber<ipc::Plan> plan;
  ipc::LayersSubscriber layers;

  static ipc::Expected<LiveBus> open(ipc::Runtime& runtime);
};

/// Writes DIR/NAME.json, a sensor's metadata, for each lidar: what its source's `meta` is to name. Errors
/// name the file.
tl::expected<void, std::string> write_metadata(const services::VehicleConfig& config,
                                               const SessionOptions& options, const std::string& folder);

/// The session is over when the planner says so and the vehicle stands, at a mishap, or when it has taken too
/// long. Its time counts from the course on: that is sent once the planner plans by layers that are fresh.
/// What the planner says of an earlier course does not count.
class LiveSession {
 public:
  /// Opens sockets and starts the lidars. All references outlive it. Errors: a lidar without
  /// `ouster-udp:PORT`.
  static tl::expected<std::unique_ptr<LiveSession>, std::string> start(
      const CourseWorld& course, const sim::World& world, const TrueObstacles& obstacles,
      const services::VehicleConfig& config, const SessionOptions& options, LiveBus bus);

  /// The next step of the vehicle, which is due when `next()` says. False: the session is over.
  bool step(double most_s, const Onlooker& onlooker);
  [[nodiscard]] std::chrono::steady_clock::time_point next() const;

  /// Of what has happened so far.
  [[nodiscard]] SessionResult result() const;
  [[nodiscard]] LiveVehicle& vehicle() { return *vehicle_; }
  [[nodiscard]] LidarStream& lidar(std::size_t index) { return *streams_[index]; }
  [[nodiscard]] const DriveLog& log() const { return result_.log; }
  /// Packets sent, late and failed, of all lidars; commands' deadlines passed.
  [[nodiscard]] std::string figures() const;

 private:
  LiveSession(const CourseWorld& course, const sim::World& world, const TrueObstacles& obstacles,
              const services::VehicleConfig& config, const SessionOptions& options, LiveBus bus);

  void take_plans(const Onlooker& onlooker);
  void show(const Onlooker& onlooker);
  void send_course();
  void write_step();
  [[nodiscard]] bool has_ended(double most_s) const;

  const CourseWorld& course_;
  const TrueObstacles& obstacles_;
  LiveBus bus_;
  std::vector<sim::LidarModel> lidars_;
  std::chrono::steady_clock::time_point begin_;
  std::unique_ptr<LiveVehicle> vehicle_;
  std::vector<std::unique_ptr<LidarStream>> streams_;
  CourseTalk talk_;
  mapping::LayerStorage shown_;
  Grid shown_grid_;
  std::optional<std::int64_t> shown_stamp_ns_;  // of the layers; nothing: none came yet
  planner::Plan plan_;
  double layers_age_s_ = 0;
  double course_sent_s_ = -1;
  int steps_ = 0;
  SessionResult result_;
};

}  // namespace gvom::driving
