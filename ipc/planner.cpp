#include "ipc/planner.hpp"

#include <algorithm>
#include <utility>

namespace gvom::ipc {
namespace {

constexpr std::chrono::milliseconds kBrokerCheckPeriod{200};

std::chrono::milliseconds until(std::chrono::steady_clock::time_point deadline) {
  return std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
}

/// At least a millisecond: when it is over, they are.
std::chrono::milliseconds until_stale(std::chrono::nanoseconds age, std::chrono::nanoseconds max_age) {
  if (max_age == kAnyAge) return std::chrono::hours(1);
  return std::chrono::floor<std::chrono::milliseconds>(max_age - age) + std::chrono::milliseconds(1);
}

Error stale(std::chrono::nanoseconds age) {
  return {ErrorKind::stale, "the newest layers are " + age_words(age), age};
}

}  // namespace

PlannerClient::PlannerClient(Runtime runtime, LayersSubscriber layers, Waiter waiter)
    : runtime_(std::move(runtime)), layers_(std::move(layers)), waiter_(std::move(waiter)) {}

Expected<PlannerClient> PlannerClient::connect(const std::string& name, std::chrono::milliseconds timeout) {
  auto runtime = Runtime::connect(name, timeout);
  if (!runtime) return tl::unexpected(runtime.error());
  auto layers = LayersSubscriber::open(*runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto waiter = Waiter::create(*runtime);
  waiter.add(*layers);
  return PlannerClient(std::move(*runtime), std::move(*layers), std::move(waiter));
}

Expected<LayersSample> PlannerClient::newest_layers(std::chrono::milliseconds timeout,
                                                    std::chrono::nanoseconds max_age) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const std::uint64_t refused_before = counters().refused();
  const bool began_stale = newest_received_ && elapsed(*newest_received_, Moment::now()) > max_age;
  while (true) {
    auto sample = layers_.take_newest();
    if (sample) newest_received_ = received_at(sample->header());
    const auto age = newest_received_ ? elapsed(*newest_received_, Moment::now()) : kUnknownAge;
    if (sample && age <= max_age) return std::move(*sample);
    if (sample || (newest_received_ && !began_stale && age > max_age)) return tl::unexpected(stale(age));
    if (!runtime_.broker_alive()) {
      return tl::unexpected(
          Error{ErrorKind::unavailable, "the broker is gone: this process must be started again"});
    }
    auto left = std::min(until(deadline), kBrokerCheckPeriod);
    if (newest_received_ && !began_stale) left = std::min(left, until_stale(age, max_age));
    if (until(deadline).count() <= 0 || waiter_.wait(left) == WaitResult::woken) {
      return tl::unexpected(nothing_new(timeout, max_age, refused_before));
    }
  }
}

/// Why a call ends with nothing.
Error PlannerClient::nothing_new(std::chrono::milliseconds waited, std::chrono::nanoseconds max_age,
                                 std::uint64_t refused_before) const {
  std::string why;
  if (counters().refused() > refused_before) why = ": " + layers_.newest_refusal();
  const auto age = newest_received_ ? elapsed(*newest_received_, Moment::now()) : max_age;
  if (age > max_age) {
    Error error = stale(age);
    error.message += why;
    return error;
  }
  return {ErrorKind::timeout, "no new layers within " + std::to_string(waited.count()) + " ms" + why};
}

Expected<std::uint64_t> PlannerClient::publish_odometry(const Odometry& odometry, std::int64_t stamp_ns,
                                                        std::uint64_t epoch) {
  if (!odometry_) {
    auto publisher = Publisher<Odometry>::open(runtime_);
    if (!publisher) return tl::unexpected(publisher.error());
    odometry_ = std::move(*publisher);
  }
  return odometry_->publish(odometry, stamp_ns, epoch);
}

}  // namespace gvom::ipc
