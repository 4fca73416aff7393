// The bridge's ends of the bus's topics.
#pragma once

#include <optional>

#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"

namespace gvom::bridge {

struct Bus {
  ipc::Runtime& runtime;
  ipc::Waiter waiter;
  ipc::LayersSubscriber layers;
  ipc::Subscriber<ipc::Odometry> odometry;
  ipc::Subscriber<ipc::Plan> plan;
  ipc::Subscriber<ipc::Health> health;
  ipc::Publisher<ipc::Health> own_health;
  /// Only while somebody wants voxels: fusion makes them for its readers.
  std::optional<ipc::BrickMapSubscriber> voxels;

  /// `runtime` outlives it.
  static ipc::Expected<Bus> open(ipc::Runtime& runtime);
};

}  // namespace gvom::bridge
