// In place of the CUDA back end in builds without CUDA.
#include "core/cuda/open.hpp"

namespace gvom::cuda {

namespace {

tl::unexpected<DeviceError> absent() {
  return tl::make_unexpected(DeviceError{"this build has no CUDA"});
}

}  // namespace

DeviceExpected<OpenBackend<FusionBackend>> open_fusion(const FusionSetup& /*setup*/) {
  return absent();
}

DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(const VoxelizerSetup& /*setup*/) {
  return absent();
}

DeviceExpected<CopyRates> measure_copies() {
  return absent();
}

}  // namespace gvom::cuda
