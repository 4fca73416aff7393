#include "services/ingest/odometry_watch.hpp"

namespace gvom::ingest {

namespace {

constexpr std::int64_t kHold_ns = 1'000'000'000;
constexpr double kLeastJump_m = 0.5;  // below it is noise
constexpr double kLeastTurn_rad = 0.2;
constexpr double kMostTurn_radps = 6.3;

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

std::uint32_t bit(std::size_t fault) {
  return std::uint32_t{1} << fault;
}

}  // namespace

OdometryWatch::OdometryWatch(const services::OdometryConfig& config)
    : max_gap_s_(config.max_gap_s), max_speed_mps_(config.max_speed_mps) {}

void OdometryWatch::begin_anew() {
  last_.reset();
  backwards_ = 0;
}

bool OdometryWatch::jumps(const StampedPose& pose) const {
  const double elapsed_s = seconds(pose.stamp_ns - last_->stamp_ns);
  const Pose& from = last_->T_odom_base;
  const Pose& to = pose.T_odom_base;
  const double moved_m = (to.translation_m - from.translation_m).norm();
  const double turned_rad = from.rotation.angularDistance(to.rotation);
  return (moved_m > kLeastJump_m && moved_m > max_speed_mps_ * elapsed_s) ||
         (turned_rad > kLeastTurn_rad && turned_rad > kMostTurn_radps * elapsed_s);
}

OdometryStep OdometryWatch::step(const StampedPose& pose, std::int64_t now_ns) {
  came_ns_ = now_ns;
  if (!OdometryBuffer::is_usable(pose.T_odom_base)) return OdometryStep::steady;  // the buffer refuses it
  if (last_ && pose.stamp_ns <= last_->stamp_ns) {
    if (++backwards_ < kAnew) return OdometryStep::steady;  // likewise
    begin_anew();
    last_ = pose;
    return OdometryStep::anew;
  }
  backwards_ = 0;
  OdometryStep step = OdometryStep::steady;
  if (last_ && seconds(pose.stamp_ns - last_->stamp_ns) > max_gap_s_) {
    see(OdometryFault::gap, seconds(pose.stamp_ns - last_->stamp_ns), now_ns);
    step = OdometryStep::gap;
  }
  if (last_ && jumps(pose)) {
    see(OdometryFault::jump, (pose.T_odom_base.translation_m - last_->T_odom_base.translation_m).norm(),
        now_ns);
    step = OdometryStep::jump;
  }
  last_ = pose;
  return step;
}

void OdometryWatch::note(OdometryBuffer::Add result, std::int64_t now_ns) {
  if (result == OdometryBuffer::Add::not_finite) see(OdometryFault::not_finite, 0, now_ns);
  if (result == OdometryBuffer::Add::not_newer) see(OdometryFault::backwards, 0, now_ns);
}

void OdometryWatch::see(OdometryFault fault, double value, std::int64_t now_ns) {
  seen_[static_cast<std::size_t>(fault)] = {value, now_ns};
}

/// A gap is told for as long as the next one may take to show, so that odometry that is too slow stays told.
bool OdometryWatch::is_seen(std::size_t fault, std::int64_t now_ns) const {
  if (seen_[fault].at_ns == 0) return false;
  const bool gap = fault == static_cast<std::size_t>(OdometryFault::gap);
  return seconds(now_ns - seen_[fault].at_ns) < seconds(kHold_ns) + (gap ? seen_[fault].value : 0);
}

std::uint32_t OdometryWatch::faults(std::int64_t now_ns) const {
  std::uint32_t faults = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (is_seen(i, now_ns)) faults |= bit(i);
  if (came_ns_ != 0 && seconds(now_ns - came_ns_) > max_gap_s_) faults |= bit(0);
  return faults;
}

void OdometryWatch::describe(std::int64_t now_ns, services::Words& words) const {
  const std::uint32_t bits = faults(now_ns);
  const auto has = [bits](OdometryFault fault) { return (bits & bit(static_cast<std::size_t>(fault))) != 0; };
  const auto value = [this](OdometryFault fault) { return seen_[static_cast<std::size_t>(fault)].value; };
  if (has(OdometryFault::silence)) words.add("no odometry for %.1f s", seconds(now_ns - came_ns_));
  if (has(OdometryFault::jump))
    words.add("odometry jumped by %.1f m: the map begins anew", value(OdometryFault::jump));
  if (has(OdometryFault::gap))
    words.add("odometry has a gap of %.2f s, more than odometry.max_gap_s %g: no sweep in it is mapped",
              value(OdometryFault::gap), max_gap_s_);
  if (has(OdometryFault::backwards)) words.add("odometry goes back in time: not used");
  if (has(OdometryFault::not_finite)) words.add("odometry is not a pose: not used");
}

}  // namespace gvom::ingest
