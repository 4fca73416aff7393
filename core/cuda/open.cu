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

// Pins the memory of the bus, and says how its maps travel.
std::string reach(Device& device, const HostMemory& memory) {
  if (memory.bytes == 0) return "maps by staged copies";
  if (const auto pinned = device.pin(memory); !pinned) return "maps by staged copies: " + pinned.error().what;
  return "maps by DMA";
}

bool reads_in_place(const Device& device, const HostMemory& memory) {
  return memory.bytes > 0 && device.in_place(memory.base) != nullptr;
}

}  // namespace

DeviceExpected<OpenBackend<FusionBackend>> open_fusion(const FusionSetup& setup) {
  auto device = Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Device& opened = **device;
  if (setup.times_kernels) opened.time_kernels();
  std::string maps = reach(opened, setup.shared);
  const bool in_place = reads_in_place(opened, setup.shared);
  if (in_place) maps = "maps in place";
  const std::string details = describe(opened.info()) + ": " + maps;
  auto backend = std::make_unique<Fusion>(std::move(*device), setup, in_place);
  if (const auto ready = opened.wait(); !ready) return tl::make_unexpected(ready.error());
  return OpenBackend<FusionBackend>{std::move(backend), "cuda", details};
}

DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(const VoxelizerSetup& setup) {
  auto device = Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Device& opened = **device;
  if (setup.times_kernels) opened.time_kernels();
  const std::string details = describe(opened.info()) + ": " + reach(opened, setup.shared);
  auto backend = std::make_unique<Voxelizer>(std::move(*device), setup);
  if (const auto ready = opened.wait(); !ready) return tl::make_unexpected(ready.error());
  return OpenBackend<VoxelizerBackend>{std::move(backend), "cuda", details};
}

}  // namespace gvom::cuda
