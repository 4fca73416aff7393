// Between the types of the mapping core and those of the messages, which know nothing of each other.
#pragma once

#include <cstddef>

#include "core/brick_map.hpp"
#include "core/layers.hpp"
#include "core/window.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/layers.hpp"

namespace gvom::services {

static_assert(sizeof(VoxelRecord) == sizeof(ipc::VoxelRecord) &&
              offsetof(VoxelRecord, passes) == offsetof(ipc::VoxelRecord, passes) &&
              offsetof(VoxelRecord, min_height_m) == offsetof(ipc::VoxelRecord, min_height_m));
static_assert(kMaxLidars == ipc::kMaxLidars);

/// Where the core writes a map: straight into the loaned chunk.
inline BrickMapArrays arrays_of(const ipc::BrickMapWriter& writer) {
  return {writer.directory().data(), writer.lookup().data(), writer.columns().data(),
          reinterpret_cast<VoxelRecord*>(writer.records().data())};
}

/// A received map, to be read where it lies.
BrickMapView view_of(const ipc::BrickMapSample& sample);

/// Where the core writes layers.
LayerArrays arrays_of(const ipc::LayersWriter& writer);

/// Grid and pose of a message that has them (BrickMap, Layers).
template <class Message>
void set_frame(const Grid& grid, const Pose& T_odom_base, Message& message) {
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    message.origin_voxels[a] = grid.origin[i];
    message.size_voxels[a] = grid.size[i];
    message.resolution_m[a] = grid.resolution_m[i];
    message.base_position_m[a] = T_odom_base.translation_m[a];
  }
  for (int k = 0; k < 4; ++k) message.base_orientation_xyzw[k] = T_odom_base.rotation.coeffs()[k];
}

Pose pose_of(const double (&position_m)[3], const double (&orientation_xyzw)[4]);

}  // namespace gvom::services
