// Opens the back end that the configuration asks for. Library gvom_backends.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "core/backend.hpp"
#include "core/config.hpp"

namespace gvom {

/// Memory of this process in which maps come and layers go out, e.g. the bus's payloads. A device is to
/// reach it by itself; nothing is known of it where it is empty.
struct HostMemory {
  void* base = nullptr;
  std::size_t bytes = 0;
};

/// A back end and what it says of itself.
template <class T>
struct OpenBackend {
  std::unique_ptr<T> backend;
  std::string name;     ///< "cpu" or "cuda".
  std::string details;  ///< For people: on what it runs, why this one, how it reaches the memory.
};

struct FusionSetup {
  MapperConfig config;
  int lidars = 1;               ///< How many have maps in the window, 1 .. kMaxLidars.
  std::size_t max_returns = 0;  ///< Of any map: its records are at most as many.
  HostMemory shared;
  bool times_kernels = false;  ///< A device notes how long each of its steps takes, and takes longer in all.
};

/// Half two. Errors: `cuda` was asked for and cannot start, with the driver's reason. `automatic` falls back
/// to the CPU and says why in `details`.
DeviceExpected<OpenBackend<FusionBackend>> open_fusion(Backend which, const FusionSetup& setup);

struct VoxelizerSetup {
  MapConfig map;
  LidarGeometry lidar;
  VehicleGeometry vehicle;
  std::size_t max_returns = 0;  ///< That a sweep can have.
  HostMemory shared;
  bool times_kernels = false;  ///< A device notes how long each of its steps takes, and takes longer in all.
};

/// Half one for one lidar; else as `open_fusion`.
DeviceExpected<OpenBackend<VoxelizerBackend>> open_voxelizer(Backend which, const VoxelizerSetup& setup);

}  // namespace gvom
