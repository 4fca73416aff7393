// The closed loop in lock-step: a vehicle moves, its lidars measure on the way, sweeps are mapped and fused,
// a driver decides by the layers.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/odometry_buffer.hpp"
#include "services/planner/process/motion.hpp"
#include "tools/drive/ablation.hpp"
#include "tools/drive/drive_log.hpp"
#include "tools/drive/rig.hpp"
#include "tools/drive/true_obstacles.hpp"
#include "tools/mapping/pipeline.hpp"
#include "tools/sim/odometry_errors.hpp"
#include "tools/sim/sweep_simulator.hpp"

namespace gvom::driving {

struct LoopOptions {
  std::uint64_t seed = 1;
  double mapping_s = 0.1;  ///< From the end of a turn until the command by its layers is given.
  sim::OdometryNoise odometry_noise;
  Ablation ablation = Ablation::none;  ///< Of what the loop does itself: deskewing, the rules.
  int threads = 1;                     ///< Lidars that are measured at a time; they do not change a byte.
};

/// What a driver knows. Layers are valid until it returns.
struct Seen {
  const LayerArrays& layers;
  const Grid& grid;
  std::int64_t stamp_ns;  ///< Of the newest return in the layers.
  double layers_age_s;    ///< When the driver's command takes effect.
  planner::State state;   ///< By the odometry, at the end of the turn; speed and curvature, too.
};

struct Decision {
  std::optional<planner::Command> command;  ///< Nothing: the vehicle hears nothing.
  bool is_done = false;                     ///< The drive ends here.
};
using Driver = std::function<Decision(const Seen&)>;

/// The same seed gives the same bytes.
class Loop {
 public:
  /// World and obstacles must outlive it.
  Loop(const sim::World& world, const TrueObstacles& obstacles, const Rig& rig, const planner::Pose2& start,
       const LoopOptions& options);
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// One turn. False: the drive has ended, by the driver or by a mishap. Errors say why a sweep could not be
  /// mapped.
  tl::expected<bool, std::string> turn(const Driver& driver);

  [[nodiscard]] const DriveLog& log() const { return log_; }

 private:
  void add_odometry(int step);
  void move();
  tl::expected<std::int64_t, std::string> map_turn();
  void write_step(const Decision& decision, double layers_age_s);
  [[nodiscard]] bool has_ended() const { return log_.is_done || log_.mishap; }

  const TrueObstacles& obstacles_;
  LoopOptions options_;
  Vehicle vehicle_;
  Watch watch_;
  sim::OdometryErrors errors_;
  OdometryBuffer odometry_;
  planner::MotionEstimate motion_;
  std::vector<sim::LidarModel> lidars_;
  std::vector<std::size_t> order_;  // of the lidars, by when their sweeps end
  std::vector<sim::SweepSimulator> simulators_;
  std::vector<Sweep> sweeps_;
  mapping::Pipeline pipeline_;
  int turns_ = 0;
  DriveLog log_;
};

/// Drives until it ends or for `seconds` of the simulated time.
tl::expected<DriveLog, std::string> drive(Loop& loop, const Driver& driver, double seconds);

}  // namespace gvom::driving
