#include "tools/drive/loop.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/sim/parallel.hpp"

namespace gvom::driving {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr int kStepsPerTurn = 10;
constexpr int kStepsBefore = 15;  // of odometry before the start: sweeps begin up to a turn earlier

/// The lidar whose sweep ends first is the first.
std::vector<std::size_t> order_of(const std::vector<sim::LidarModel>& lidars) {
  std::vector<std::size_t> order(lidars.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lidars[a].start_ns < lidars[b].start_ns; });
  return order;
}

std::size_t most_returns(const std::vector<sim::LidarModel>& lidars) {
  return static_cast<std::size_t>(lidars.front().beams()) * lidars.front().columns;
}

std::int64_t stamp_of(int step) {
  return sim::kStartNs + step * kStep_ns;
}

}  // namespace

Loop::Loop(const sim::World& world, const TrueObstacles& obstacles, const Rig& rig,
           const planner::Pose2& start, const LoopOptions& options)
    : obstacles_(obstacles),
      options_(options),
      vehicle_(world.terrain(), rig.model, start),
      watch_(world, rig.model),
      errors_(options.odometry_noise, kSteps_hz, options.seed),
      motion_(services::OdometryConfig{}),
      lidars_(make_lidars(rig, options.seed)),
      order_(order_of(lidars_)),
      sweeps_(lidars_.size()),
      pipeline_(rig.mapping, most_returns(lidars_), make_fusion(rig.mapping.mapper, options.ablation)) {
  sim::SweepOptions measured;
  measured.seed = options.seed;
  for (const sim::LidarModel& lidar : lidars_) simulators_.emplace_back(world, vehicle_, lidar, measured);
  for (int step = -kStepsBefore; step <= 0; ++step) add_odometry(step);
}

void Loop::add_odometry(int step) {
  const StampedPose pose{stamp_of(step), errors_.disturb(vehicle_.T_odom_base())};
  odometry_.add(pose);
  motion_.take(pose, 0);
}

/// For the length of a turn, unless something happens.
void Loop::move() {
  for (int i = 1; i <= kStepsPerTurn && !log_.mishap; ++i) {
    vehicle_.step();
    log_.driven_m += std::abs(vehicle_.state().speed_mps) * kStep_s;
    add_odometry(turns_ * kStepsPerTurn + i);
    log_.mishap = watch_.look(vehicle_);
  }
}

/// Stamp of the newest sweep.
tl::expected<std::int64_t, std::string> Loop::map_turn() {
  sim::parallel_for(static_cast<int>(lidars_.size()), options_.threads,
                    [&](int i) { simulators_[i].measure(turns_, sweeps_[i]); });
  if (options_.ablation == Ablation::deskew_off)
    for (Sweep& sweep : sweeps_) forget_times(sweep);
  for (const std::size_t lidar : order_)
    if (const auto mapped = pipeline_.add(lidar, sweeps_[lidar], odometry_); !mapped)
      return tl::unexpected(mapped.error());
  return sweeps_[order_.back()].stamp_ns;
}

tl::expected<bool, std::string> Loop::turn(const Driver& driver) {
  if (has_ended()) return false;
  move();
  Decision decision;
  double age_s = 0;
  if (!log_.mishap) {
    const auto stamp_ns = map_turn();
    if (!stamp_ns) return tl::unexpected(stamp_ns.error());
    const planner::State state = motion_.state().value_or(planner::State{});  // it has poses since the start
    age_s = 1e-9 * static_cast<double>(state.stamp_ns - *stamp_ns) + options_.mapping_s;
    decision = driver({pipeline_.make_layers(), pipeline_.grid(), *stamp_ns, age_s, state});
    if (decision.command) vehicle_.command(vehicle_.time_s() + options_.mapping_s, *decision.command);
  }
  log_.is_done = decision.is_done;
  write_step(decision, age_s);
  ++turns_;
  return !has_ended();
}

void Loop::write_step(const Decision& decision, double layers_age_s) {
  const VehicleState& state = vehicle_.state();
  DriveStep step{vehicle_.time_s(),     vehicle_.T_odom_base(), state.place,  state.speed_mps,
                 state.curvature_per_m, decision.command,       layers_age_s, 0};
  step.nearest_m = obstacles_.nearest_m(vehicle_.model().limits, state.place, step.time_s);
  log_.add(step);
  log_.bushes_driven_through = watch_.bushes_driven_through();
  log_.grass_driven_through = watch_.grass_driven_through();
}

tl::expected<DriveLog, std::string> drive(Loop& loop, const Driver& driver, double seconds) {
  while (loop.log().seconds() < seconds - 0.5 * kTurn_s) {
    const auto goes_on = loop.turn(driver);
    if (!goes_on) return tl::unexpected(goes_on.error());
    if (!*goes_on) break;
  }
  return loop.log();
}

}  // namespace gvom::driving
