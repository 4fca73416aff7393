#include "tools/drive/cli/session.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "ipc/text.hpp"
#include "services/planner/planner.hpp"
#include "services/planner/process/sides.hpp"

namespace gvom::driving {
namespace {

constexpr double kMinute_s = 60;
constexpr double kStands_mps = 0.05;
constexpr double kLongStop_s = 1.0;

/// That this thread has had of a processor: what else runs does not count.
double processor_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// What gvom-planner is told by Layers of lidars from which nothing comes: all but the first `left`.
planner::Senses senses_with(const services::VehicleConfig& config, std::size_t left) {
  ipc::Layers layers{};
  for (; layers.lidar_count < left; ++layers.lidar_count)
    ipc::set_text(layers.lidars[layers.lidar_count].name, config.lidars[layers.lidar_count].name);
  const planner::Sides sides = planner::sides_of(config.lidars);
  planner::Senses senses;
  senses.blind_ahead = planner::is_blind(layers, sides.ahead);
  senses.blind_behind = planner::is_blind(layers, sides.behind);
  return senses;
}

/// The planner as a driver.
class Chauffeur {
 public:
  Chauffeur(const services::VehicleConfig& config, std::size_t lidars,
            const std::vector<Eigen::Vector2d>& waypoints_m, const Onlooker& onlooker)
      : planner_(config.planner, config.mapper.map.size_xy),
        senses_(senses_with(config, lidars)),
        onlooker_(onlooker) {
    planner_.set_course(waypoints_m);
  }

  Decision operator()(const Seen& seen) {
    const planner::MapView view = planner::map_view(seen.layers, seen.grid, seen.stamp_ns);
    planner::Senses senses = senses_;
    senses.layers_age_s = seen.layers_age_s;
    const double begun_ms = processor_ms();
    const planner::Plan& plan = planner_.cycle(&view, seen.state, senses);
    cycle_ms_.push_back(processor_ms() - begun_ms);
    if (onlooker_) onlooker_(seen, plan);
    mode_ = plan.mode;
    why_ = plan.why;
    return {plan.command, mode_ == planner::Mode::gave_up || (mode_ == planner::Mode::arrived &&
                                                              std::abs(seen.state.speed_mps) < kStands_mps)};
  }

  [[nodiscard]] planner::Mode mode() const { return mode_; }
  [[nodiscard]] const std::string& why() const { return why_; }
  [[nodiscard]] const std::vector<double>& cycle_ms() const { return cycle_ms_; }

 private:
  planner::Planner planner_;
  const planner::Senses senses_;
  const Onlooker& onlooker_;
  planner::Mode mode_ = planner::Mode::stop;
  std::string why_;
  std::vector<double> cycle_ms_;
};

/// Stands that begin after the start and end before the end.
int count_stops(const DriveLog& log) {
  int stops = 0;
  double stands_s = 0;
  bool has_driven = false;
  for (const DriveStep& step : log.steps) {
    const bool stands = std::abs(step.speed_mps) < kStands_mps;
    if (!stands && has_driven && stands_s > kLongStop_s) ++stops;
    stands_s = stands ? stands_s + kTurn_s : 0;
    has_driven = has_driven || !stands;
  }
  return stops;
}

}  // namespace

sim::Sensor sensor_of(const services::VehicleConfig& config) {
  constexpr int kReturnsOf128 = 128 * 1024;
  const bool is_128 = !config.lidars.empty() && config.lidars.front().max_returns == kReturnsOf128;
  return is_128 ? sim::Sensor::os1_128 : sim::Sensor::os1_64;
}

Rig rig_of(const services::VehicleConfig& config, sim::Sensor sensor) {
  Rig rig;
  rig.model.limits = config.planner.vehicle;
  rig.model.base_height_m = config.mapper.vehicle.base_height_m;
  rig.mapping.mapper = config.mapper;
  for (const services::LidarConfig& lidar : config.lidars) rig.mapping.lidars.push_back(lidar.geometry);
  rig.sensor = sensor;
  return rig;
}

const char* words_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::arrived:
      return "arrived";
    case Outcome::mishap:
      return "mishap";
    case Outcome::gave_up:
      return "gave up";
    case Outcome::too_slow:
      break;
  }
  return "too slow";
}

void judge(planner::Mode mode, const std::string& why, SessionResult& result) {
  const DriveLog& log = result.log;
  if (log.mishap)
    result.outcome = Outcome::mishap;
  else if (mode == planner::Mode::arrived)
    result.outcome = Outcome::arrived;
  else if (mode == planner::Mode::gave_up)
    result.outcome = Outcome::gave_up;
  result.end = log.mishap ? describe(*log.mishap) : why;
  result.false_stops = count_stops(log);
  for (const DriveStep& step : log.steps)
    result.top_speed_mps = std::max(result.top_speed_mps, step.speed_mps);
}

double most_seconds(const SessionOptions& options, const std::optional<TrueWay>& way) {
  return kMinute_s + options.patience * (way ? way->seconds : kMinute_s);
}

std::optional<TrueWay> true_way(const sim::GroundTruth& truth, const CourseWorld& course,
                                const planner::PlannerConfig& planning) {
  const double speed_mps = std::min(planning.speed_mps, planning.vehicle.max_speed_mps);
  return TruthPlanner(truth, {planning.vehicle.width_m, speed_mps, planning.goal_tolerance_m})
      .plan(course.start.place(), course.waypoints_m);
}

tl::expected<SessionResult, std::string> run_session(const CourseWorld& course,
                                                     const services::VehicleConfig& config,
                                                     const SessionOptions& options,
                                                     const Onlooker& onlooker) {
  if (std::abs(config.planner.rate_hz * kTurn_s - 1) > 1e-9)
    return tl::unexpected(config.path + ": planner.rate_hz: in lock-step it plans once a turn, at " +
                          std::to_string(std::lround(1 / kTurn_s)) + " Hz");
  const auto rig = ablated(rig_of(config, options.sensor), options.ablation);
  if (!rig) return tl::unexpected(rig.error());
  const sim::World world(course.data);
  const sim::GroundTruth truth =
      sim::sample_truth(world, {config.mapper.map.resolution_xy_m, 0.0, options.threads});
  const TrueObstacles obstacles(world, truth);
  SessionResult result;
  result.way = true_way(truth, course, config.planner);
  LoopOptions loop_options;
  loop_options.seed = options.seed;
  loop_options.odometry_noise = options.odometry_noise;
  loop_options.ablation = options.ablation;
  loop_options.threads = options.threads;
  Loop loop(world, obstacles, *rig, course.start, loop_options);
  Chauffeur chauffeur(config, rig->mapping.lidars.size(), course.waypoints_m, onlooker);
  auto log = drive(
      loop, [&chauffeur](const Seen& seen) { return chauffeur(seen); }, most_seconds(options, result.way));
  if (!log) return tl::unexpected(log.error());
  result.log = std::move(*log);
  judge(chauffeur.mode(), chauffeur.why(), result);
  result.cycle_ms = chauffeur.cycle_ms();
  return result;
}

}  // namespace gvom::driving
