// The CUDA back end's way in. Where CUDA was not found at build time, `absent.cpp` stands in for all of it.
#pragma once

#include "core/open_backend.hpp"

namespace gvom::cuda {

/// As the functions of the same names in core/open_backend.hpp, on the first CUDA device. Errors: there is
/// none, or it cannot be used; in the driver's words.
DeviceExpected<OpenBackend<FusionBackend>> open_fusion(const FusionSetup& setup);
DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(const VoxelizerSetup& setup);

/// How fast the device copies large blocks, bytes per second.
struct CopyRates {
  double to_device;      ///< From pinned host memory.
  double to_host;        ///< To pinned host memory.
  double within_device;  ///< Bytes read plus bytes written.
};

DeviceExpected<CopyRates> measure_copies();

}  // namespace gvom::cuda
