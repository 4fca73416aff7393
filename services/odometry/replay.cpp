#include "services/odometry/replay.hpp"

#include <algorithm>
#include <cstdio>

#include <spdlog/spdlog.h>

namespace gvom::odometry {

using namespace std::chrono_literals;
using services::ExitCode;
using std::chrono::steady_clock;

namespace {

constexpr auto kLongestWait = 100ms;  // between looks at the broker, the watchdog and the stop
constexpr std::int64_t kStallNs = 10'000'000'000;
constexpr std::int64_t kDrainStallNs = 30'000'000'000;
constexpr std::int64_t kSilentNs = 2'000'000'000;  // a reader says something four times a second
constexpr std::int64_t kWorthSayingNs = 1'000'000'000;
constexpr std::int64_t kLongestPauseNs = 10'000'000'000;  // of a recording; no sweep within one is mapped

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(ipc::monotonic_ns());
}

/// What of the time between two poses is not waited for: one stamp of 0 before those of a clock would be a
/// pause of fifty years. Told.
std::int64_t beyond_longest_pause_ns(std::int64_t before_ns, std::int64_t stamp_ns) {
  const std::int64_t pause_ns = stamp_ns - before_ns;
  if (pause_ns <= kLongestPauseNs) return 0;
  spdlog::warn("the odometry pauses for {:.1f} s after {:.3f} s: going on after {} s of them",
               1e-9 * static_cast<double>(pause_ns), 1e-9 * static_cast<double>(before_ns),
               kLongestPauseNs / 1'000'000'000);
  return pause_ns - kLongestPauseNs;
}

ipc::Odometry message_of(const Pose& pose, std::uint32_t flags) {
  ipc::Odometry message{};
  message.T_odom_base = record_of(pose);
  message.flags = flags;
  return message;
}

}  // namespace

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime) {
  auto odometry = ipc::Publisher<ipc::Odometry>::open(runtime);
  if (!odometry) return tl::make_unexpected(odometry.error());
  auto health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!health) return tl::make_unexpected(health.error());
  auto progress = ipc::Subscriber<ipc::Progress>::open(runtime);
  if (!progress) return tl::make_unexpected(progress.error());
  auto waiter = ipc::Waiter::create(runtime);
  waiter.add(*progress);
  return Bus{std::move(*odometry), std::move(*health), std::move(*progress), std::move(waiter)};
}

Replay::Replay(const std::vector<StampedPose>& poses, const std::vector<std::string>& lidars,
               const ReplayOptions& options, ipc::Runtime& runtime, Bus& bus, services::Lifecycle& lifecycle)
    : poses_(poses),
      options_(options),
      bus_(bus),
      lifecycle_(lifecycle),
      broker_(runtime, lifecycle),
      epoch_(now_ns()),
      readers_(lidars, epoch_),
      health_(runtime.name(), options.config_hash),
      published_(health_.counter("published")),
      rounds_(health_.counter("rounds")),
      restarts_(health_.counter("reader_restarts")),
      foreign_(health_.counter("refused_progress")),
      lateness_(health_.stage("lateness")) {
  lifecycle_.on_stop([this] { bus_.waiter.wake(); });
}

Replay::~Replay() {
  lifecycle_.on_stop({});
}

ExitCode Replay::run() {
  const auto begin = steady_clock::now();
  Outcome outcome = wait_for_readers();
  while (outcome) {
    outcome = play_round().and_then([this] { return drain(); });
    if (!outcome) break;
    ++rounds_;
    if (!options_.loop) break;
    epoch_ = std::max(epoch_ + 1, now_ns());
    spdlog::info("round {} is through, beginning again", rounds_);
  }
  const std::chrono::duration<double> took = steady_clock::now() - begin;
  spdlog::info("{} odometry messages in {:.1f} s, {} whole rounds of {} poses, {} maps made of them",
               published_, took.count(), rounds_, poses_.size(), readers_.maps_published());
  health_.set_state(ipc::HealthState::stopping);
  publish_health();
  broker_.leave_if_gone();
  return outcome ? ExitCode::ok : outcome.error();
}

Replay::Outcome Replay::wait_for_readers() {
  const auto deadline = steady_clock::now() + options_.wait_readers;
  health_.set_state(ipc::HealthState::starting, "waiting for readers");
  while (!readers_.missing().empty() && steady_clock::now() < deadline) {
    if (const Outcome served = serve(kLongestWait); !served) return served;
  }
  health_.set_state(ipc::HealthState::ok);
  const std::vector<std::string> missing = readers_.missing();
  if (missing.empty()) return {};
  const std::string message =
      fmt::format("no sign within {:.1f} s of: {}",
                  std::chrono::duration<double>(options_.wait_readers).count(), joined(missing));
  if (!options_.lossless) {
    spdlog::warn("{}; starting without", message);
    return {};
  }
  spdlog::error("{}; a lossless replay needs all its readers", message);
  return tl::make_unexpected(ExitCode::try_again);
}

Replay::Outcome Replay::play_round() {
  const auto begin = steady_clock::now();
  std::int64_t skipped_ns = 0;
  std::int64_t last_ns = poses_.front().stamp_ns;
  for (const StampedPose& pose : poses_) {
    if (!options_.lossless) skipped_ns += beyond_longest_pause_ns(last_ns, pose.stamp_ns);
    last_ns = pose.stamp_ns;
    const auto since_first = static_cast<double>(pose.stamp_ns - poses_.front().stamp_ns - skipped_ns);
    const std::chrono::nanoseconds at{static_cast<std::int64_t>(since_first / options_.rate)};
    const Outcome waited = options_.lossless ? wait_for_room() : wait_until(begin + at);
    if (!waited) return waited;
    if (const Outcome sent = publish(pose, 0); !sent) return sent;
  }
  return {};
}

Replay::Outcome Replay::wait_for_room() {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  Outcome served = serve(0ms);
  while (served && published_ >= readers_.slowest()->acknowledged + kMostAhead) {
    const Reader& slowest = *readers_.slowest();
    const std::int64_t stalled_ns = ipc::monotonic_ns() - std::max(begin_ns, slowest.advanced_ns);
    if (stalled_ns > kStallNs) {
      spdlog::error("no progress for {} s: {}", kStallNs / 1'000'000'000,
                    joined(readers_.outstanding(published_)));
      return tl::make_unexpected(ExitCode::try_again);
    }
    if (stalled_ns > kWorthSayingNs) {
      health_.set_state(ipc::HealthState::degraded, "waiting for " + slowest.name);
    }
    served = serve(kLongestWait);
  }
  if (health_.state() == ipc::HealthState::degraded) health_.set_state(ipc::HealthState::ok);
  return served;
}

Replay::Outcome Replay::wait_until(steady_clock::time_point deadline) {
  Outcome served = serve(0ms);
  while (served) {
    const auto remaining = std::chrono::floor<std::chrono::milliseconds>(deadline - steady_clock::now());
    if (remaining < 2ms) break;
    served = serve(std::min<std::chrono::milliseconds>(remaining - 1ms, kLongestWait));
  }
  if (!served) return served;
  if (!lifecycle_.sleep_until(deadline)) return tl::make_unexpected(ExitCode::ok);
  lateness_.record_ns(std::chrono::nanoseconds(steady_clock::now() - deadline).count());
  return {};
}

Replay::Outcome Replay::drain() {
  if (const Outcome sent = publish(poses_.back(), ipc::Odometry::kEndOfStream); !sent) return sent;
  const std::int64_t begin_ns = ipc::monotonic_ns();
  while (true) {
    if (const Outcome served = serve(kLongestWait); !served) return served;
    const std::int64_t heard_since_ns = options_.lossless ? 0 : ipc::monotonic_ns() - kSilentNs;
    const auto outstanding = readers_.outstanding(published_, heard_since_ns);
    if (outstanding.empty()) return {};
    if (ipc::monotonic_ns() - std::max(begin_ns, readers_.last_advance_ns()) <= kDrainStallNs) continue;
    spdlog::log(options_.lossless ? spdlog::level::err : spdlog::level::warn,
                "the recording is through, but no reader came further for {} s: {}",
                kDrainStallNs / 1'000'000'000, joined(outstanding));
    if (options_.lossless) return tl::make_unexpected(ExitCode::try_again);
    return {};
  }
}

Replay::Outcome Replay::publish(const StampedPose& pose, std::uint32_t flags) {
  if (options_.lossless) flags |= ipc::Odometry::kLossless;
  const auto sent = bus_.odometry.publish(message_of(pose.T_odom_base, flags), pose.stamp_ns, epoch_);
  if (!sent) {
    spdlog::error("odometry {}: {}", published_ + 1, sent.error().message);
    return tl::make_unexpected(services::exit_code_of(sent.error()));
  }
  published_ = *sent;
  health_.count_product();
  return {};
}

Replay::Outcome Replay::serve(std::chrono::milliseconds timeout) {
  bus_.waiter.wait(timeout);
  take_progress();
  if (health_.due(ipc::monotonic_ns())) publish_health();
  services::notify_watchdog();
  if (lifecycle_.stopping()) return tl::make_unexpected(ExitCode::ok);
  return {};
}

void Replay::take_progress() {
  while (const auto progress = bus_.progress.take()) {
    const Reader* const restarted = readers_.take(**progress, published_, ipc::monotonic_ns());
    if (restarted == nullptr) continue;
    ++restarts_;
    spdlog::warn("'{}' began anew: it goes on after odometry {}", restarted->name, published_);
  }
  foreign_ = bus_.progress.counters().refused();
  while (const auto refusal = bus_.progress.new_refusal()) spdlog::warn("progress refused: {}", *refusal);
}

void Replay::publish_health() {
  const std::int64_t now = ipc::monotonic_ns();
  const auto sent = bus_.health.publish(health_.take(now), now, epoch_);
  if (!sent) spdlog::warn("health: {}", sent.error().message);
  char status[128];
  std::snprintf(status, sizeof(status), "%llu odometry messages, %llu rounds of %zu poses",
                static_cast<unsigned long long>(published_), static_cast<unsigned long long>(rounds_),
                poses_.size());
  services::notify_status(status);
}

}  // namespace gvom::odometry
