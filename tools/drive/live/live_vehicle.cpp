#include "tools/drive/live/live_vehicle.hpp"

#include <cmath>
#include <utility>

#include "ipc/clock.hpp"
#include "tools/sim/sweep_simulator.hpp"

namespace gvom::driving {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr int kStepsBefore = 15;  // sweeps begin up to a turn before the start
constexpr double kStands_mps = 0.05;

}  // namespace

ipc::Expected<VehicleBus> VehicleBus::open(ipc::Runtime& runtime) {
  auto odometry = ipc::Publisher<ipc::Odometry>::open(runtime);
  if (!odometry) return tl::unexpected(odometry.error());
  auto command = ipc::Subscriber<ipc::Command>::open(runtime);
  if (!command) return tl::unexpected(command.error());
  return VehicleBus{std::move(*odometry), std::move(*command)};
}

LiveVehicle::LiveVehicle(const sim::World& world, const VehicleModel& model, const planner::Pose2& start,
                         const sim::OdometryNoise& noise, std::uint64_t seed, VehicleBus bus)
    : bus_(std::move(bus)),
      vehicle_(world.terrain(), model, start),
      watch_(world, model),
      errors_(noise, kSteps_hz, seed),
      epoch_(static_cast<std::uint64_t>(ipc::monotonic_ns())) {
  for (int step = -kStepsBefore; step <= 0; ++step) tell(sim::kStartNs + step * kStep_ns);
}

void LiveVehicle::take_commands() {
  while (const auto sample = bus_.command.take()) {
    const ipc::Command& message = **sample;
    command_ = planner::Command{message.speed_mps, message.curvature_per_m};
    deadline_ns_ = message.mono_deadline_ns;
  }
  if (!command_) return;
  planner::Command now = *command_;
  if (ipc::monotonic_ns() > deadline_ns_) {
    if (std::abs(vehicle_.state().speed_mps) > kStands_mps) ++deadlines_passed_;
    command_.reset();
    now.speed_mps = 0;
  }
  vehicle_.command(vehicle_.time_s(), now);
}

void LiveVehicle::step() {
  if (mishap_) return;
  {
    const std::lock_guard lock(mutex_);
    take_commands();
    vehicle_.step();
  }
  mishap_ = watch_.look(vehicle_);
  ++steps_;
  tell(sim::kStartNs + steps_ * kStep_ns);
}

void LiveVehicle::tell(std::int64_t stamp_ns) {
  said_ = {stamp_ns, errors_.disturb(vehicle_.T_odom_base())};
  said_.T_odom_base.translation_m += jumped_m_;
  if (!tells_) return;
  ipc::Odometry message{};
  message.T_odom_base = record_of(said_.T_odom_base);
  static_cast<void>(bus_.odometry.publish(message, stamp_ns, epoch_));
}

Pose LiveVehicle::at(double time_s) const {
  const std::lock_guard lock(mutex_);
  return vehicle_.at(time_s);
}

double LiveVehicle::time_s() const {
  const std::lock_guard lock(mutex_);
  return vehicle_.time_s();
}

}  // namespace gvom::driving
