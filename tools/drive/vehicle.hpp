// A vehicle that drives over the simulated ground as it is told: actuators with a delay, kinematics, slip.
#pragma once

#include <cstddef>
#include <vector>

#include "services/planner/planner.hpp"
#include "tools/drive/stance.hpp"
#include "tools/sim/motion.hpp"

namespace gvom::driving {

inline constexpr double kStep_s = 0.01;
inline constexpr int kSteps_hz = 100;

struct VehicleState {
  planner::Pose2 place;        ///< Of base_link in odom.
  double wheel_speed_mps = 0;  ///< Negative: backwards.
  double speed_mps = 0;        ///< Along the heading, over the ground: less than the wheels' where they slip.
  double curvature_per_m = 0;  ///< That the steering is at; positive: to the left.
};

class Vehicle : public sim::Motion {
 public:
  /// Stands at `start`. The terrain must outlive it.
  Vehicle(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& start);

  /// Given at a time that is no earlier than that of the command before.
  void command(double time_s, const planner::Command& command);
  /// Moves on by `kStep_s`.
  void step();

  /// Of the drive so far. Before its start it stood, after now it is taken to stand.
  [[nodiscard]] Pose at(double time_s) const override;

  [[nodiscard]] double time_s() const { return kStep_s * static_cast<double>(poses_.size() - 1); }
  [[nodiscard]] const VehicleState& state() const { return state_; }
  [[nodiscard]] const Stance& stance() const { return stance_; }
  [[nodiscard]] const Pose& T_odom_base() const { return poses_.back(); }
  [[nodiscard]] const VehicleModel& model() const { return model_; }

 private:
  struct Timed {
    double time_s;
    planner::Command command;
  };

  planner::Command heard();
  void move_actuators(const planner::Command& wanted);
  void move_body();
  [[nodiscard]] double brake_mps2() const;

  const sim::Terrain& terrain_;
  VehicleModel model_;
  VehicleState state_;
  Stance stance_;
  std::vector<Pose> poses_;  // one a step
  std::vector<Timed> commands_;
  std::size_t heard_ = 0;  // commands that have come through the delay
};

}  // namespace gvom::driving
