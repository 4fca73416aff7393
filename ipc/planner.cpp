#include "ipc/planner.hpp"

#include <algorithm>
#include <utility>

namespace gvom::ipc {
namespace {

constexpr std::chrono::milliseconds kBrokerCheckPeriod{200};

std::chrono::milliseconds until(std::chrono::steady_clock::time_point deadline) {
  return std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
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

Expected<LayersSample> PlannerClient::newest_layers(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const std::uint64_t refused_before = counters().refused();
  while (true) {
    if (auto sample = layers_.take_newest()) return std::move(*sample);
    if (!runtime_.broker_alive()) {
      return tl::unexpected(
          Error{ErrorKind::unavailable, "the broker is gone: this process must be started again"});
    }
    const auto left = until(deadline);
    if (left.count() <= 0 || waiter_.wait(std::min(left, kBrokerCheckPeriod)) == WaitResult::woken) {
      std::string why = "no new layers within " + std::to_string(timeout.count()) + " ms";
      if (counters().refused() > refused_before) why += ": " + layers_.newest_refusal();
      return tl::unexpected(Error{ErrorKind::timeout, std::move(why)});
    }
  }
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
