#include "services/ingest/odometry_intake.hpp"

namespace gvom::ingest {

namespace {

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

std::int64_t nanoseconds(double duration_s) {
  return static_cast<std::int64_t>(duration_s * 1e9);
}

SweepLoss loss_of(Reach reach) {
  if (reach == Reach::gap) return SweepLoss::gap;
  return reach == Reach::jump ? SweepLoss::jump : SweepLoss::before_odometry;
}

}  // namespace

OdometryIntake::OdometryIntake(const services::OdometryConfig& config, Sweeps sweeps, std::size_t capacity)
    : config_(config), live_(sweeps == Sweeps::live), judge_(config), poses_(capacity) {}

void OdometryIntake::begin_epoch(std::uint64_t epoch) {
  epoch_ = epoch;
  poses_.clear();
  judge_.begin_anew();
  span_.reset();
  ended_ = false;
}

Taken OdometryIntake::take(const OdometryNews& news, std::int64_t now_ns) {
  if (news.epoch < epoch_) {
    ++counts_.old_epoch;
    seen_.see(OdometryFault::old_epoch, 0, now_ns);
    return Taken::old_epoch;
  }
  if (news.epoch > epoch_) begin_epoch(news.epoch);
  ++counts_.poses;
  came_ns_ = now_ns;
  ended_ = news.end_of_stream;
  return ended_ ? Taken::end : take_pose(news.pose, now_ns);
}

Taken OdometryIntake::take_pose(const StampedPose& pose, std::int64_t now_ns) {
  const PoseJudge::Verdict verdict = judge_.judge(pose);
  Taken taken = Taken::used;
  PoseLink link = PoseLink::steady;
  switch (verdict.step) {
    case PoseStep::steady:
      break;
    case PoseStep::gap:
      // Told for as long as the next one may take to show, so that odometry that is too slow stays told.
      seen_.see(OdometryFault::gap, verdict.value, now_ns,
                Sightings<OdometryFault>::kHold_ns + nanoseconds(verdict.value));
      ++counts_.gaps;
      link = PoseLink::gap;
      taken = Taken::gap;
      break;
    case PoseStep::jump:
      seen_.see(OdometryFault::jump, verdict.value, now_ns);
      ++counts_.jumps;
      link = PoseLink::jump;
      taken = Taken::jump;
      break;
    case PoseStep::anew:
      seen_.see(OdometryFault::backwards, 0, now_ns);
      ++counts_.gaps;
      poses_.clear();
      span_.reset();
      taken = Taken::anew;
      break;
    case PoseStep::not_a_pose:
      seen_.see(OdometryFault::not_finite, 0, now_ns);
      ++counts_.not_finite;
      return Taken::not_a_pose;
    case PoseStep::backwards:
      seen_.see(OdometryFault::backwards, 0, now_ns);
      ++counts_.not_newer;
      return Taken::backwards;
  }
  poses_.add(pose, link);
  span_ = TimeSpan{span_ ? span_->first_ns : pose.stamp_ns, pose.stamp_ns};
  return taken;
}

Placement OdometryIntake::judge(const Sweep& sweep, std::int64_t since_ns, std::int64_t now_ns) const {
  using When = Placement::When;
  const bool reached = !poses_.empty() && poses_.newest_ns() >= sweep.stamp_ns;
  const Reach reach = reached ? poses_.reach(span_of(sweep)) : Reach::later;
  if (reach == Reach::covered) return {When::now};
  if (reach != Reach::later) return {When::never, loss_of(reach)};
  if (live_ && now_ns - since_ns > nanoseconds(config_.timeout_s)) return {When::never, SweepLoss::timeout};
  if (!live_ && ended_) return {When::never, SweepLoss::after_odometry};
  return {When::later};
}

void OdometryIntake::note(SweepLoss why, std::int64_t now_ns) {
  if (why == SweepLoss::timeout) seen_.see(OdometryFault::timeout, 0, now_ns);
}

/// A replay sets its own pace.
bool OdometryIntake::is_silent(std::int64_t now_ns) const {
  return live_ && came_ns_ != 0 && seconds(now_ns - came_ns_) > config_.max_gap_s;
}

std::uint32_t OdometryIntake::faults(std::int64_t now_ns) const {
  return seen_.bits(now_ns) | (is_silent(now_ns) ? 1U << static_cast<unsigned>(OdometryFault::silence) : 0);
}

void OdometryIntake::describe(std::int64_t now_ns, services::Words& words) const {
  const auto has = [&](OdometryFault fault) { return seen_.has(fault, now_ns); };
  if (is_silent(now_ns)) words.add("no odometry for %.1f s", seconds(now_ns - came_ns_));
  if (has(OdometryFault::jump))
    words.add("odometry jumped by %.1f m: the map begins anew", seen_.value(OdometryFault::jump));
  if (has(OdometryFault::gap))
    words.add("odometry has a gap of %.2f s, more than odometry.max_gap_s %g: no sweep in it is mapped",
              seen_.value(OdometryFault::gap), config_.max_gap_s);
  if (has(OdometryFault::timeout) && poses_.empty()) words.add("no odometry yet");
  if (has(OdometryFault::timeout) && !poses_.empty() && !is_silent(now_ns))
    words.add("no odometry for sweeps within odometry.timeout_s %g: not mapped", config_.timeout_s);
  if (has(OdometryFault::backwards)) words.add("odometry goes back in time: not used");
  if (has(OdometryFault::not_finite)) words.add("odometry is not a pose: not used");
  if (has(OdometryFault::old_epoch)) words.add("odometry of an old epoch: not used");
}

}  // namespace gvom::ingest
