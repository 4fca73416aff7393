// The simulated vehicle on the bus: it does what commands say, and tells its odometry.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "ipc/fixed.hpp"
#include "ipc/messages.hpp"
#include "tools/drive/mishap.hpp"
#include "tools/drive/vehicle.hpp"
#include "tools/sim/odometry_errors.hpp"

namespace gvom::driving {

/// Its ends of the topics.
struct VehicleBus {
  ipc::Publisher<ipc::Odometry> odometry;
  ipc::Subscriber<ipc::Command> command;

  static ipc::Expected<VehicleBus> open(ipc::Runtime& runtime);
};

/// One thread steps; any may ask where it was.
class LiveVehicle : public sim::Motion {
 public:
  /// The world must outlive it. Stands at `start`, and has told odometry for the time before the first sweep.
  LiveVehicle(const sim::World& world, const VehicleModel& model, const planner::Pose2& start,
              const sim::OdometryNoise& noise, std::uint64_t seed, VehicleBus bus);

  /// Moves on by `kStep_s`; after a mishap no more. A command counts until its deadline: then it brakes.
  void step();

  [[nodiscard]] Pose at(double time_s) const override;
  [[nodiscard]] double time_s() const;

  /// Of the thread that steps.
  [[nodiscard]] const Vehicle& vehicle() const { return vehicle_; }
  [[nodiscard]] const Watch& watch() const { return watch_; }
  [[nodiscard]] const std::optional<Mishap>& mishap() const { return mishap_; }
  /// What holds; nothing: none came yet, or its deadline has passed.
  [[nodiscard]] const std::optional<planner::Command>& command() const { return command_; }
  /// The newest pose as odometry says it.
  [[nodiscard]] const StampedPose& odometry() const { return said_; }
  /// Of its odometry.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  /// How often it had to brake by itself, at speed.
  [[nodiscard]] std::uint64_t deadlines_passed() const { return deadlines_passed_; }

  // Faults of odometry.
  void let_odometry(bool on) { tells_ = on; }
  /// From now on it says that it is so far beside.
  void jump(const Eigen::Vector3d& by_m) { jumped_m_ = by_m; }

 private:
  void take_commands();
  void tell(std::int64_t stamp_ns);

  VehicleBus bus_;
  mutable std::mutex mutex_;  // of vehicle_
  Vehicle vehicle_;
  Watch watch_;
  sim::OdometryErrors errors_;
  const std::uint64_t epoch_;
  int steps_ = 0;
  StampedPose said_;
  std::optional<Mishap> mishap_;
  std::optional<planner::Command> command_;
  std::int64_t deadline_ns_ = 0;
  std::uint64_t deadlines_passed_ = 0;
  bool tells_ = true;
  Eigen::Vector3d jumped_m_ = Eigen::Vector3d::Zero();
};

}  // namespace gvom::driving
