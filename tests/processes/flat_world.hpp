// A vehicle on flat ground that does what a planner commands, for tests of the planner's process: it
// publishes its odometry and layers of the ground around it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "services/common/vehicle_config.hpp"
#include "tests/ipc/processes.hpp"

namespace gvom::test {

class FlatWorld {
 public:
  /// Joins the bus; on it when the constructor returns. `config` says the map's size.
  explicit FlatWorld(const services::VehicleConfig& config);
  ~FlatWorld();
  FlatWorld(const FlatWorld&) = delete;
  FlatWorld& operator=(const FlatWorld&) = delete;

  [[nodiscard]] bool is_up() const { return up_; }
  /// Before the broker does. What it said stays readable.
  void leave() { child_.kill(); }

  // What it lets out, all at first.
  void let_layers(bool on) { state_->layers = on; }
  void let_odometry(bool on) { state_->odometry = on; }
  /// As layers name the lidar "front".
  void lose_front(bool missing) { state_->front_missing = missing; }
  void send_course(double x_m, double y_m) { send_course({{x_m, y_m}}); }
  void send_course(const std::vector<ipc::Course::Place>& places);

  [[nodiscard]] double x_m() const { return state_->x_m; }
  [[nodiscard]] double speed_mps() const { return state_->speed_mps; }
  [[nodiscard]] std::uint64_t commands() const { return state_->commands; }
  /// How often it braked since no command held any more.
  [[nodiscard]] std::uint64_t deadlines_passed() const { return state_->deadlines_passed; }
  /// Of the newest plan: the place that it drives to.
  [[nodiscard]] std::uint32_t waypoint() const { return state_->waypoint; }
  /// Of the newest plan.
  [[nodiscard]] ipc::PlanMode mode() const { return static_cast<ipc::PlanMode>(state_->mode.load()); }
  [[nodiscard]] std::string why() const;

 private:
  struct State {
    std::atomic<bool> layers{true}, odometry{true}, front_missing{false};
    std::atomic<bool> new_course{false};
    ipc::Course course{};  // while `new_course` is false
    std::atomic<double> x_m{0}, speed_mps{0};
    std::atomic<std::uint64_t> commands{0}, deadlines_passed{0};
    std::atomic<std::uint32_t> mode{0}, waypoint{0};
    std::atomic<int> why_version{0};
    std::array<char, sizeof(ipc::Plan::why)> why{};
  };

  void live(const services::VehicleConfig& config);

  State* state_;
  ipc::test::Step up_step_;
  ipc::test::Child child_;
  bool up_ = false;
};

}  // namespace gvom::test
