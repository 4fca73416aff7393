#include "services/planner/cycle.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/room.hpp"
#include "services/planner/stance.hpp"
#include "services/planner/words.hpp"

namespace gvom::planner {
namespace {

constexpr std::int64_t kUnseenPatience_ns = 5'000'000'000;
constexpr double kInObstacle_m = 0.2;  // half a cell: so far off may a cell's middle be from what is in it

}  // namespace

SearchResult Planner::Impl::search(const MapView& map, const Predicted& at) {
  const double around_m = fan_.reach_m(std::max(0.0, at.speed_mps)) + 2;
  const int all = map.grid.size[0] * map.grid.size[1];
  return search_.run(costs_, at.pose.place(), course_.waypoint(), around_m, all);
}

double Planner::Impl::cost_from(const Predicted& at) const {
  const int cell = costs_.cells().index_of(at.pose.x_m, at.pose.y_m);
  return cell >= 0 ? search_.cost_to_go()[cell] : Plan::kNoWay;
}

bool Planner::Impl::find_way(const MapView& map, const Predicted& at) {
  SearchResult result = search(map, at);
  const auto fails = [&] { return result != SearchResult::found && result != SearchResult::cut; };
  if (fails() && !closed_.empty()) {
    closed_.clear();
    view_ = movers_.close(map);
    costs_.update(view_);
    result = search(map, at);
  }
  if (fails() && !movers_.empty()) {
    brake_for_movers(map, at);
    return false;
  }
  if (fails()) {
    const double away_m = (now_.pose.place() - course_.waypoint()).norm();
    const bool stands_in = result != SearchResult::no_way && room_now_m_ < -kInObstacle_m;
    stop(stands_in                                  ? Reason::stands_in_obstacle
         : result == SearchResult::goal_in_obstacle ? Reason::goal_in_obstacle
                                                    : Reason::no_way);
    say(plan_.why, "stops: %s, waypoint %zu, %.1f m away", words_of(plan_.reason), plan_.waypoint, away_m);
    return false;
  }
  plan_.searched.assign(search_.path().begin(), search_.path().end());
  if (const double cost = cost_from(at); std::isfinite(cost)) cost_to_go_ = cost;
  plan_.cost_to_go = cost_to_go_;
  place_goal();
  look_beyond_goal(at);
  return true;
}

void Planner::Impl::place_goal() {
  const Eigen::Vector2d& end_m = search_.path().back();
  const double moved_m = (end_m - course_.waypoint()).norm(), cell_m = costs_.cells().cell_m;
  const bool moved = moved_m > cell_m && moved_m <= Search::kGoalSlack_m + cell_m;
  const bool on_map = costs_.cells().index_of(course_.waypoint().x(), course_.waypoint().y()) >= 0;
  course_.move_goal(moved && on_map ? end_m : course_.waypoint());
}

void Planner::Impl::look_beyond_goal(const Predicted& at) {
  const double reach_m = std::max(fan_.reach_m(std::max(0.0, at.speed_mps)), config_.horizon_m);
  const double way_m = static_cast<double>(plan_.searched.size()) * costs_.cells().cell_m;
  const bool ends_at_goal = (plan_.searched.back() - course_.goal()).norm() <= costs_.cells().cell_m;
  knows_next_ = course_.next() != nullptr && ends_at_goal && way_m < reach_m;
  if (!knows_next_) return;
  const SearchResult result =
      next_search_.run(costs_, course_.goal(), *course_.next(), reach_m, costs_.cells().count());
  knows_next_ = result == SearchResult::found || result == SearchResult::cut;
}

void Planner::Impl::make_guide() {
  guide_.assign(plan_.searched.begin(), plan_.searched.end());
  if (!knows_next_) return;
  for (const Eigen::Vector2d& place : next_search_.path())
    if (guide_.size() < guide_.capacity()) guide_.push_back(place);
}

void Planner::Impl::drive_on(const Trajectory& best, const Predicted& at, const Senses& senses) {
  plan_.seen_m = best.seen_m;
  plan_.trajectory.assign(best.points.begin(), best.points.end());
  const End end = best.reached && course_.is_last() ? End::goal : best.blocked ? End::blocked : End::horizon;
  const double now_mps = std::max(0.0, at.speed_mps), period_s = 1 / config_.rate_hz;
  const SpeedLimits& limits = profile_.make(view_, now_mps, best.seen_m, end, plan_.trajectory);
  plan_.reason = limits.reasons.front();
  plan_.command.curvature_per_m = follow(config_, at, plan_.trajectory);
  plan_.command.speed_mps =
      std::min({plan_.trajectory.front().speed_mps, speed_at(plan_.trajectory, now_mps * period_s),
                now_mps + config_.vehicle.max_accel_mps2 * period_s});
  if (!lead_is_free()) {
    stop(movers_.empty() ? Reason::no_trajectory : Reason::mover);
    return say(plan_.why, "stops: something is in the way that it drives before it can answer");
  }
  driven_.assign(plan_.trajectory.begin(), plan_.trajectory.end());
  plan_.mode = plan_.command.speed_mps > 0 ? Mode::drive : Mode::stop;
  if (plan_.reason == Reason::unseen_ground && plan_.mode == Mode::drive &&
      plan_.command.speed_mps <= config_.creep_mps)
    plan_.mode = Mode::creep;
  explain(limits);
  watch_unseen(senses);
}

void Planner::Impl::explain(const SpeedLimits& limits) {
  const double speed_mps = plan_.command.speed_mps;
  if (plan_.reason == Reason::none) return say(plan_.why, "drives %.1f m/s", speed_mps);
  const char* does = plan_.mode == Mode::stop ? "stops" : plan_.mode == Mode::creep ? "creeps" : "drives";
  if (plan_.reason == Reason::no_trajectory)
    return say(plan_.why, "%s %.1f m/s: the way is free for %.1f m only", does, speed_mps,
               limits.reason_places_m.front());
  say(plan_.why, "%s %.1f m/s: %s in %.1f m", does, speed_mps, words_of(plan_.reason),
      limits.reason_places_m.front());
}

bool Planner::Impl::lead_is_free() const {
  return std::all_of(prediction_.way().begin(), prediction_.way().end(), [&](const Pose2& pose) {
    return costs_.fits(pose) || gets_no_nearer(costs_, config_.vehicle, pose, room_now_m_);
  });
}

void Planner::Impl::brake_for_movers(const MapView& map, const Predicted& at) {
  view_ = movers_.discourage(closed_.close(map));
  costs_.update(view_);
  const SearchResult result = search(map, at);
  if (result == SearchResult::found || result == SearchResult::cut) {
    plan_.searched.assign(search_.path().begin(), search_.path().end());
    plan_.cost_to_go = cost_from(at);
    knows_next_ = false;
    make_guide();
    plan_.path = optimiser_.optimise(costs_, at.pose, at.curvature_per_m, at.speed_mps, guide_);
    if (const Trajectory* best = fan_.choose(fan_input(at))) {
      driven_.assign(best->points.begin(), best->points.end());
      brake_along(at.speed_mps, SpeedProfile::kBrakeShare * config_.vehicle.max_decel_mps2, driven_);
    }
  }
  stop(Reason::mover);
}

void Planner::Impl::stand_without_trajectory(const Senses& senses) {
  stop(room_now_m_ < -kInObstacle_m ? Reason::stands_in_obstacle : Reason::no_trajectory);
  say(plan_.why, "stops: %s, and the nearest obstacle is %.1f m off%s", words_of(plan_.reason), room_now_m_,
      senses.blind_behind ? "; it cannot back, no lidar looks there" : "");
  if (!retreat_.block(stamp_ns_, stands(), senses.blind_behind)) return;
  const double away_m = config_.vehicle.front_m + ClosedPlaces::kRadius_m + 0.5;
  for (const Eigen::Vector2d& place : plan_.searched)
    if ((place - now_.pose.place()).norm() >= away_m) {
      if ((place - now_.pose.place()).dot(now_.pose.forward()) > 0) closed_.add(place);
      return;
    }
}

void Planner::Impl::back(const Predicted& at, const Senses& senses) {
  if (senses.blind_behind) {
    retreat_.end();
    stop(Reason::blind_side);
    return say(plan_.why, "stops: no lidar that looks back has a map in the window");
  }
  const auto command = retreat_.back(costs_, at);
  if (!command) {
    fan_.forget();
    stop(Reason::dead_end);
    return say(plan_.why, "stops: has backed %.1f m out of a dead end", retreat_.backed_m());
  }
  plan_.mode = Mode::back;
  plan_.reason = Reason::dead_end;
  plan_.command = *command;
  say(plan_.why, "backs out of a dead end, %.1f m so far", retreat_.backed_m());
}

void Planner::Impl::raise_onto_ground() {
  const double here_m = height_at(view_, now_.pose.x_m, now_.pose.y_m);
  double z_m = std::isfinite(here_m) ? here_m : base_z_m_;
  for (PathPoint& point : plan_.path) {
    const double ground_m = height_at(view_, point.pose.x_m, point.pose.y_m);
    point.z_m = z_m = std::isfinite(ground_m) ? ground_m : z_m;
  }
  z_m = std::isfinite(here_m) ? here_m : base_z_m_;
  for (TrajectoryPoint& point : plan_.trajectory)
    point.z_m = z_m = std::isfinite(point.z_m) ? point.z_m : z_m;
}

void Planner::Impl::watch_unseen(const Senses& senses) {
  const bool waits = plan_.reason == Reason::unseen_ground && plan_.mode == Mode::stop && stands();
  if (!waits) return unseen_since_ns_.reset();
  if (!unseen_since_ns_) unseen_since_ns_ = stamp_ns_;
  if (stamp_ns_ - *unseen_since_ns_ < kUnseenPatience_ns) return;
  unseen_since_ns_.reset();
  const auto seen = static_cast<std::size_t>(plan_.seen_m / Fan::kStep_m);
  const Pose2& last = plan_.trajectory[std::min(seen, plan_.trajectory.size() - 1)].pose;
  const double ahead_m = config_.vehicle.front_m + ClosedPlaces::kRadius_m + 0.5;
  closed_.add(last.place() + ahead_m * last.forward());
  retreat_.begin(senses.blind_behind);
}

void Planner::Impl::watch_progress() {
  const double away_m = (now_.pose.place() - course_.waypoint()).norm();
  if (!progress_.update(stamp_ns_, cost_to_go_, away_m)) return;
  gave_up_ = true;
}

}  // namespace gvom::planner
