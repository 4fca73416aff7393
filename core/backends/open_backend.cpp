#include "core/open_backend.hpp"

#include "core/cpu/fusion.hpp"
#include "core/cpu/voxelizer.hpp"
#include "core/cuda/open.hpp"

namespace gvom {

namespace {

// `on_device` and `on_cpu` open the same half.
template <class T, class OnDevice, class OnCpu>
DeviceExpected<OpenBackend<T>> open(Backend which, OnDevice&& on_device, OnCpu&& on_cpu) {
  if (which == Backend::cpu) return OpenBackend<T>{on_cpu(), "cpu", "as configured"};
  DeviceExpected<OpenBackend<T>> device = on_device();
  if (device || which == Backend::cuda) return device;
  return OpenBackend<T>{on_cpu(), "cpu", "no GPU: " + device.error().what};
}

}  // namespace

DeviceExpected<OpenBackend<FusionBackend>> open_fusion(Backend which, const FusionSetup& setup) {
  return open<FusionBackend>(
      which, [&] { return cuda::open_fusion(setup); },
      [&] { return std::make_unique<cpu::Fusion>(setup.config); });
}

DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(Backend which, const VoxelizerSetup& setup) {
  return open<VoxelizerBackend>(
      which, [&] { return cuda::open_voxelizer(setup); },
      [&] {
        return std::make_unique<cpu::Voxelizer>(setup.map, setup.lidar, setup.vehicle, setup.max_returns);
      });
}

}  // namespace gvom
