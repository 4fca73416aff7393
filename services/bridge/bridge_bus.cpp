#include "services/bridge/bridge_bus.hpp"

namespace gvom::bridge {

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime) {
  auto layers = ipc::LayersSubscriber::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto odometry = ipc::Subscriber<ipc::Odometry>::open(runtime);
  if (!odometry) return tl::unexpected(odometry.error());
  auto plan = ipc::Subscriber<ipc::Plan>::open(runtime);
  if (!plan) return tl::unexpected(plan.error());
  auto health = ipc::Subscriber<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  auto own_health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!own_health) return tl::unexpected(own_health.error());
  Bus bus{runtime,          ipc::Waiter::create(runtime), std::move(*layers),     std::move(*odometry),
          std::move(*plan), std::move(*health),           std::move(*own_health), std::nullopt};
  bus.waiter.add(bus.layers);
  bus.waiter.add(bus.plan);
  return bus;
}

}  // namespace gvom::bridge
