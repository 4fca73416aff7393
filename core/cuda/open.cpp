#include "core/cuda/open.hpp"

#include <utility>

#include "core/cuda/fusion.hpp"
#include "core/cuda/voxelizer.hpp"

namespace gvom::cuda {

namespace {

// What the device is.
std::string describe(const DeviceInfo& info) {
  const auto dotted = [](int major, int minor) {
    return std::to_string(major) + "." + std::to_string(minor);
  };
  return info.name + " (compute capability " +
         dotted(info.compute_capability / 10, info.compute_capability % 10) + ", driver for CUDA " +
         dotted(info.driver_version / 1000, info.driver_version % 1000 / 10) + ")";
}

// Pins the memory that maps come in, and says how the device reaches it.
std::string reach(Device& device, const HostMemory& memory) {
  if (memory.bytes == 0) return "copies from pageable memory";
  if (const auto pinned = device.pin(memory); !pinned)
    return "staged copies, the shared memory cannot be pinned: " + pinned.error().what;
  return device.info().shares_host_memory ? "shared memory read in place"
                                          : "copies by DMA from shared memory";
}

bool reads_in_place(const Device& device, const HostMemory& memory) {
  return memory.bytes > 0 && device.in_place(memory.base) != nullptr;
}

}  // namespace

DeviceExpected<OpenBackend<FusionBackend>> open_fusion(const FusionSetup& setup) {
  auto device = Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Device& opened = **device;
  const std::string details = describe(opened.info()) + ": " + reach(opened, setup.shared);
  auto backend = std::make_unique<Fusion>(std::move(*device), setup, reads_in_place(opened, setup.shared));
  if (const auto ready = opened.wait(); !ready) return tl::make_unexpected(ready.error());
  return OpenBackend<FusionBackend>{std::move(backend), "cuda", details};
}

DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(const VoxelizerSetup& setup) {
  auto device = Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Device& opened = **device;
  const std::string details = describe(opened.info()) + ": " + reach(opened, setup.shared);
  auto backend = std::make_unique<Voxelizer>(std::move(*device), setup);
  if (const auto ready = opened.wait(); !ready) return tl::make_unexpected(ready.error());
  return OpenBackend<VoxelizerBackend>{std::move(backend), "cuda", details};
}

}  // namespace gvom::cuda
