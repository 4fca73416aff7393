#include "services/ingest/odometry_intake.hpp"

#include <algorithm>
#include <cstdlib>

namespace gvom::ingest {

namespace {

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

std::int64_t nanoseconds(double duration_s) {
  return static_cast<std::int64_t>(duration_s * 1e9);
}

/// Of odometry.max_gap_s. A wrong stamp once is no gap of years.
constexpr double kLongestGap_s = 60;

/// A clock that seems to be wrong is looked at again for so long.
constexpr std::int64_t kClockPatience_ns = 300'000'000;

/// The sensor's time when its last packet came, with a return in it or not.
std::int64_t newest_ns(const Sweep& sweep) {
  std::int64_t newest_ns = sweep.stamp_ns;
  for (const std::int64_t time_ns : sweep.times_ns) newest_ns = std::max(newest_ns, time_ns);
  return newest_ns;
}

SweepLoss loss_of(Reach reach) {
  if (reach == Reach::gap) return SweepLoss::gap;
  return reach == Reach::jump ? SweepLoss::jump : SweepLoss::before_odometry;
}

/// Where the clock went back nothing says that the frame is the same: maps from before must go.
PoseLink link_of(Taken taken) {
  if (taken == Taken::gap) return PoseLink::gap;
  return taken == Taken::jump || taken == Taken::anew ? PoseLink::jump : PoseLink::steady;
}

}  // namespace

OdometryIntake::OdometryIntake(const services::OdometryConfig& config, Sweeps sweeps, std::size_t capacity)
    : config_(config), live_(sweeps == Sweeps::live), judge_(config), poses_(capacity) {}

void OdometryIntake::begin_epoch(std::uint64_t epoch) {
  epoch_ = epoch;
  poses_.clear();
  judge_.begin_anew();
  clock_.forget();
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
  const services::PoseJudge::Verdict verdict = judge_.judge(pose);
  const Taken taken = note_step(verdict, now_ns);
  if (taken == Taken::not_a_pose || taken == Taken::backwards) return taken;
  if (taken == Taken::gap || taken == Taken::anew) clock_.forget();
  if (taken == Taken::anew) {
    poses_.clear();
    span_.reset();
  }
  poses_.add(pose, link_of(taken));
  clock_.take_odometry(pose.stamp_ns, now_ns);
  span_ = TimeSpan{span_ ? span_->first_ns : pose.stamp_ns, pose.stamp_ns};
  return taken;
}

/// Counts and tells what is not steady.
Taken OdometryIntake::note_step(const services::PoseJudge::Verdict& verdict, std::int64_t now_ns) {
  switch (verdict.step) {
    case services::PoseStep::steady:
      break;
    case services::PoseStep::gap:
      // Told for as long as the next one may take to show, so that odometry that is too slow stays told.
      seen_.see(OdometryFault::gap, verdict.value, now_ns,
                Sightings<OdometryFault>::kHold_ns + nanoseconds(std::min(verdict.value, kLongestGap_s)));
      return ++counts_.gaps, Taken::gap;
    case services::PoseStep::jump:
      seen_.see(OdometryFault::jump, verdict.value, now_ns);
      return ++counts_.jumps, Taken::jump;
    case services::PoseStep::anew:
      seen_.see(OdometryFault::backwards, 0, now_ns);
      return ++counts_.gaps, Taken::anew;
    case services::PoseStep::not_a_pose:
      seen_.see(OdometryFault::not_finite, 0, now_ns);
      return ++counts_.not_finite, Taken::not_a_pose;
    case services::PoseStep::repeated:
      return ++counts_.not_newer, Taken::backwards;
    case services::PoseStep::backwards:
      seen_.see(OdometryFault::backwards, 0, now_ns);
      return ++counts_.not_newer, Taken::backwards;
  }
  return Taken::used;
}

void OdometryIntake::note_refused(std::uint64_t all, const std::string& why, std::int64_t now_ns) {
  if (all == counts_.refused) return;
  counts_.refused = all;
  refusal_ = why;
  seen_.see(OdometryFault::refused, 0, now_ns);
}

Placement OdometryIntake::judge(const Sweep& sweep, std::int64_t since_ns, std::int64_t now_ns) const {
  using When = Placement::When;
  const auto ahead = ahead_ns(sweep);
  if (ahead && std::llabs(*ahead) > nanoseconds(config_.max_clock_offset_s)) {
    const std::int64_t patience_ns = std::min(kClockPatience_ns, nanoseconds(config_.timeout_s));
    if (now_ns - since_ns <= patience_ns) return {When::later};
    return {When::never, SweepLoss::clock};
  }
  const bool reached = !poses_.empty() && poses_.newest_ns() >= sweep.stamp_ns;
  const Reach reach = reached ? poses_.reach(span_of(sweep)) : Reach::later;
  if (reach == Reach::covered) return {When::now};
  if (reach != Reach::later) return {When::never, loss_of(reach)};
  if (live_ && now_ns - since_ns > nanoseconds(config_.timeout_s)) return {When::never, SweepLoss::timeout};
  if (!live_ && ended_) return {When::never, SweepLoss::after_odometry};
  return {When::later};
}

/// Nothing if there is nothing to compare with.
std::optional<std::int64_t> OdometryIntake::ahead_ns(const Sweep& sweep) const {
  if (!live_ || sweep.received_ns == 0) return std::nullopt;
  return clock_.ahead_ns(newest_ns(sweep), sweep.received_ns);
}

void OdometryIntake::note(const Sweep& sweep, SweepLoss why, std::int64_t now_ns) {
  if (const auto ahead = ahead_ns(sweep); why == SweepLoss::clock && ahead) {
    seen_.see(OdometryFault::clock, seconds(*ahead), now_ns);
    clock_guess_ = guess_clock(*ahead, sweep.stamp_ns, sweep.stamp_ns - *ahead);
  }
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
  if (has(OdometryFault::clock)) describe_clock(words);
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
  if (has(OdometryFault::refused)) words.add("%s", refusal_.c_str());
}

void OdometryIntake::describe_clock(services::Words& words) const {
  const double ahead_s = seen_.value(OdometryFault::clock);
  const bool known = *clock_guess_ != '\0';
  words.add(
      "the lidar's clock is %.1f s %s the odometry's%s%s%s: nothing is mapped beyond "
      "odometry.max_clock_offset_s %g",
      std::abs(ahead_s), ahead_s < 0 ? "behind" : "ahead of", known ? " (" : "", clock_guess_,
      known ? ")" : "", config_.max_clock_offset_s);
}

}  // namespace gvom::ingest
