#include "services/common/bus/core_types.hpp"

namespace gvom::services {

Pose pose_of(const double (&position_m)[3], const double (&q)[4]) {
  return {{position_m[0], position_m[1], position_m[2]}, {q[3], q[0], q[1], q[2]}};
}

BrickMapView view_of(const ipc::BrickMapSample& sample) {
  const ipc::BrickMap& header = sample.header();
  BrickMapView view;
  for (std::size_t a = 0; a < 3; ++a) {
    view.grid.origin[a] = header.origin_voxels[a];
    view.grid.size[a] = header.size_voxels[a];
    view.grid.resolution_m[a] = header.resolution_m[a];
  }
  view.stamp_ns = header.header.stamp_ns;
  view.T_odom_base = pose_of(header.base_position_m, header.base_orientation_xyzw);
  view.shape = {header.brick_slots, header.brick_count, header.record_count};
  view.directory = sample.directory().data();
  view.lookup = sample.lookup().data();
  view.columns = sample.columns().data();
  view.records = reinterpret_cast<const VoxelRecord*>(sample.records().data());
  const auto* begin = reinterpret_cast<const std::byte*>(view.directory);
  const auto* end = reinterpret_cast<const std::byte*>(view.records + view.shape.record_count);
  view.bytes_in_one = static_cast<std::size_t>(end - begin);
  return view;
}

LayerArrays arrays_of(const ipc::LayersWriter& writer) {
  using ipc::LayerId;
  const auto f = [&](LayerId id) { return writer.layer_f(id).data(); };
  const auto u8 = [&](LayerId id) { return writer.layer_u8(id).data(); };
  LayerArrays arrays{f(LayerId::height),
                     f(LayerId::inferred_height),
                     f(LayerId::slope_x),
                     f(LayerId::slope_y),
                     f(LayerId::slope),
                     f(LayerId::roughness),
                     f(LayerId::obstacle_density),
                     f(LayerId::negative_delta),
                     f(LayerId::clearance),
                     f(LayerId::last_seen),
                     u8(LayerId::flags),
                     u8(LayerId::visibility),
                     u8(LayerId::cost)};
  const auto last = writer.layer_u8(LayerId::cost);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(arrays.height);
  arrays.bytes_in_one = static_cast<std::size_t>(last.data() + last.size() - begin);
  return arrays;
}

}  // namespace gvom::services
