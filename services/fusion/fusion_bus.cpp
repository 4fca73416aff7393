#include <utility>

#include "services/common/bus/pool_spec.hpp"
#include "services/fusion/fusion_node.hpp"

namespace gvom::fusion {

ipc::Expected<Bus> Bus::open(ipc::Runtime& runtime, const services::VehicleConfig& config) {
  auto waiter = ipc::Waiter::create(runtime);
  auto inbox = MapInbox::open(runtime, waiter, config);
  if (!inbox) return tl::unexpected(inbox.error());
  auto layers = ipc::LayersPublisher::open(runtime);
  if (!layers) return tl::unexpected(layers.error());
  auto voxels = ipc::BrickMapPublisher::voxel_map(runtime, voxel_map_capacity(services::pool_spec(config)));
  if (!voxels) return tl::unexpected(voxels.error());
  auto progress = ipc::Publisher<ipc::Progress>::open(runtime);
  if (!progress) return tl::unexpected(progress.error());
  auto health = ipc::Publisher<ipc::Health>::open(runtime);
  if (!health) return tl::unexpected(health.error());
  return Bus{std::move(waiter),  std::move(*inbox),    std::move(*layers),
             std::move(*voxels), std::move(*progress), std::move(*health)};
}

}  // namespace gvom::fusion
