#include "services/planner/planner.hpp"

#include <cstdlib>
#include <utility>

#include "services/planner/cycle.hpp"
#include "services/planner/room.hpp"
#include "services/planner/words.hpp"

namespace gvom::planner {
namespace {

constexpr double kStands_mps = 0.1;
constexpr double kWaits_mps = 2.5;                     // slower than that it lets pass who is beside it
constexpr std::int64_t kLongWait_ns = 30'000'000'000;  // for movers: from then on it comes no nearer
constexpr int kStandCycles = 3;  // what a jump of the odometry says of the speed is nothing at first

}  // namespace

Planner::Planner(const PlannerConfig& config, int n_xy) : impl_(std::make_unique<Impl>(config, n_xy)) {}
Planner::~Planner() = default;
void Planner::set_course(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first) {
  impl_->set_course(std::move(waypoints_m), first);
}
const Plan& Planner::cycle(const MapView* map, const State& state, const Senses& senses) {
  return impl_->cycle(map, state, senses);
}
const Plan& Planner::stand(Reason reason, const char* why) {
  return impl_->stand(reason, why);
}

Planner::Impl::Impl(const PlannerConfig& config, int n_xy)
    : config_(config),
      n_xy_(n_xy),
      costs_(config.costmap, config.vehicle, n_xy),
      search_(n_xy),
      next_search_(n_xy),
      optimiser_(config),
      fan_(config),
      profile_(config, fan_.most_points()),
      prediction_(config),
      kept_(n_xy, config.blind_m),
      soft_(n_xy, config.blind_m),
      closed_(n_xy),
      movers_(config.vehicle, n_xy, config.blind_m),
      retreat_(config),
      course_(config),
      progress_(config.give_up_s) {
  const auto longest_path = static_cast<std::size_t>(n_xy) * 8;
  plan_.searched.reserve(longest_path);
  guide_.reserve(longest_path);
  plan_.path.reserve(static_cast<std::size_t>(config.horizon_m / PathOptimiser::kStep_m) + 2);
  plan_.trajectory.reserve(fan_.most_points());
  driven_.reserve(fan_.most_points());
  plan_.why.reserve(kLongestWhy);
}

void Planner::Impl::set_course(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first) {
  course_.set(std::move(waypoints_m), first);
  closed_.clear();
  retreat_.end();
  fan_.forget();
  progress_.begin();
  arrived_ = gave_up_ = false;
}

void Planner::Impl::begin_plan() {
  plan_.searched.clear();
  plan_.path.clear();
  plan_.trajectory.clear();
  plan_.seen_m = 0;
  plan_.cost_to_go = Plan::kNoWay;
}

const Plan& Planner::Impl::cycle(const MapView* map, const State& state, const Senses& senses) {
  begin_plan();
  observe(state, senses);
  bool may_progress = may_plan(map, senses);
  if (may_progress) {
    drive(*map, senses);
    raise_onto_ground();
    if (plan_.reason == Reason::mover) movers_.wait(now_.pose.place(), stamp_ns_);
    may_progress =
        (movers_.empty() || movers_.waited_ns() > kLongWait_ns) && plan_.reason != Reason::blind_side;
  }
  if (may_progress)
    watch_progress();
  else
    progress_.wait(stamp_ns_);
  prediction_.add(plan_.command);
  return plan_;
}

const Plan& Planner::Impl::stand(Reason reason, const char* why) {
  begin_plan();
  plan_.mode = Mode::stop;
  plan_.reason = reason;
  plan_.command.speed_mps = 0;
  say(plan_.why, "%s", why);
  prediction_.add(plan_.command);
  return plan_;
}

void Planner::Impl::forget_place() {
  retreat_.forget();
  closed_.clear();
  kept_.clear();
  soft_.clear();
  movers_.clear();
  driven_.clear();
  fan_.forget();
}

void Planner::Impl::observe(const State& state, const Senses& senses) {
  if (std::abs(state.stamp_ns - stamp_ns_) > static_cast<std::int64_t>(1e9 * Progress::kMostAtOnce_s)) {
    unseen_since_ns_.reset();
    retreat_.clear();
  }
  stamp_ns_ = state.stamp_ns;
  base_z_m_ = state.T_odom_base.translation_m.z();
  now_ = {flat(state.T_odom_base), state.speed_mps, state.curvature_per_m};
  if (senses.odometry_jumped) {
    jump_ns_ = stamp_ns_;
    must_stand_ = kStandCycles;
    forget_place();
  }
  retreat_.observe(now_.pose);
  const std::size_t before = course_.index();
  course_.update(now_.pose.place());
  if (course_.index() != before) progress_.begin();
  plan_.waypoint = course_.index();
}

bool Planner::Impl::may_plan(const MapView* map, const Senses& senses) {
  if (course_.empty()) {
    stop(Reason::no_course);
  } else if (gave_up_) {
    stop(Reason::no_progress, Mode::gave_up);
    say(plan_.why, "gave up: in %.0f s it came no nearer to waypoint %zu", config_.give_up_s, plan_.waypoint);
  } else if (arrived_ || (at_end() && stands())) {
    arrived_ = true;
    stop(Reason::near_goal, Mode::arrived);
    say(plan_.why, "arrived: %.1f m from the last waypoint", (now_.pose.place() - course_.waypoint()).norm());
  } else if (senses.overrun_s > 0) {
    stop(Reason::overrun);
    say(plan_.why, "stops: the last cycle took %.0f ms", 1e3 * senses.overrun_s);
  } else if (!may_use(map, senses)) {
    return false;
  } else if (must_stand_ > 0) {
    must_stand_ = stands() ? must_stand_ - 1 : kStandCycles;
    stop(Reason::odometry_jump);
    say(plan_.why, "stops: odometry jumped; it goes on from a stand");
  } else {
    jump_ns_.reset();
    if (!at_end() || (course_.goal() - now_.pose.place()).dot(now_.pose.forward()) > 0) return true;
    stop(Reason::near_goal);
    say(plan_.why, "stops: the goal is %.1f m away, and it comes no nearer",
        (now_.pose.place() - course_.goal()).norm());
  }
  return false;
}

bool Planner::Impl::may_use(const MapView* map, const Senses& senses) {
  if (jump_ns_ && map == nullptr) {
    stop(Reason::odometry_jump);
    say(plan_.why, "stops: odometry jumped, and there is no map from after that");
  } else if (map == nullptr) {
    stop(Reason::no_layers);
  } else if (map->cells().n > n_xy_) {
    stop(Reason::no_layers);
    say(plan_.why, "stops: layers of %d x %d columns, the vehicle's file says %d", map->cells().n,
        map->cells().n, n_xy_);
  } else if (jump_ns_ && map->stamp_ns <= *jump_ns_) {
    stop(Reason::odometry_jump);
    say(plan_.why, "stops: odometry jumped, and the map is %.2f s older than that",
        static_cast<double>(*jump_ns_ - map->stamp_ns) * 1e-9);
  } else if (senses.layers_age_s > config_.max_age_s) {
    stop(Reason::stale_layers);
    say(plan_.why, "stops: the layers are %.2f s old, more than %.2f s", senses.layers_age_s,
        config_.max_age_s);
  } else {
    return true;
  }
  return false;
}

bool Planner::Impl::at_end() const {
  return course_.is_last() && course_.at_goal(now_.pose.place());
}

void Planner::Impl::drive(const MapView& seen, const Senses& senses) {
  const MapView kept = kept_.keep(seen, now_.pose.place());
  const MapView map = soft_.soften(kept, seen, now_.pose.place());
  movers_.observe(kept_.holes(seen), now_.pose.place(), now_.speed_mps);
  view_ = movers_.close(closed_.close(map));
  costs_.update(view_);
  const Predicted& at = prediction_.from(now_);
  room_now_m_ = room_m(costs_, config_.vehicle, now_.pose);
  if (retreat_.backs()) return back(at, senses);
  if (senses.blind_ahead) {
    stop(Reason::blind_side);
    return say(plan_.why, "stops: no lidar that looks ahead has a map in the window");
  }
  if (std::abs(now_.speed_mps) < kWaits_mps && movers_.reach(now_.pose)) return brake_for_movers(map, at);
  if (!find_way(map, at)) return;
  if (now_.speed_mps < -kStands_mps) {
    stop(Reason::dead_end);
    return say(plan_.why, "stops: has backed %.1f m out of a dead end", retreat_.backed_m());
  }
  make_guide();
  plan_.path = optimiser_.optimise(costs_, at.pose, at.curvature_per_m, at.speed_mps, guide_);
  const Trajectory* best = fan_.choose(fan_input(at));
  if (best != nullptr) drive_on(*best, at, senses);
  const bool leads_on = best != nullptr && best->leads_on;
  if (!leads_on && !movers_.empty()) return brake_for_movers(map, at);
  if (!leads_on) return stand_without_trajectory(senses);
  retreat_.clear();
}

FanInput Planner::Impl::fan_input(const Predicted& at) const {
  FanInput input;
  input.map = &view_;
  input.costs = &costs_;
  input.cost_to_go = search_.cost_to_go();
  input.path = &plan_.path;
  input.waypoint_m = course_.goal();
  input.next_m = course_.next();
  if (knows_next_) input.next_cost_to_go = next_search_.cost_to_go();
  input.pose = at.pose;
  input.curvature_per_m = at.curvature_per_m;
  input.speed_mps = std::max(0.0, at.speed_mps);
  return input;
}

bool Planner::Impl::stands() const {
  return std::abs(now_.speed_mps) < kStands_mps;
}

void Planner::Impl::stop(Reason reason, Mode mode) {
  plan_.mode = mode;
  plan_.reason = reason;
  plan_.command.speed_mps = 0;
  if (driven_.empty() || now_.speed_mps < kStands_mps) return say(plan_.why, "stops: %s", words_of(reason));
  const Predicted& at = prediction_.from(now_);
  const auto away_m = [&](std::size_t i) { return (driven_[i].pose.place() - at.pose.place()).norm(); };
  while (driven_.size() > 2 && away_m(1) < away_m(0)) driven_.erase(driven_.begin());
  plan_.command.curvature_per_m = follow(config_, at, driven_);
  say(plan_.why, "stops: %s", words_of(reason));
}

}  // namespace gvom::planner
