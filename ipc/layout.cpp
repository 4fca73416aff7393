#include "ipc/layout.hpp"

namespace gvom::ipc {
namespace {

constexpr std::size_t align(std::size_t offset) {
  return (offset + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
}

}  // namespace

BrickMapLayout brick_map_layout(std::uint32_t brick_slots, std::uint32_t brick_count,
                                std::uint32_t record_count) {
  BrickMapLayout layout{};
  layout.directory = align(sizeof(BrickMap));
  layout.lookup = align(layout.directory + brick_slots * sizeof(std::int32_t));
  layout.columns = align(layout.lookup + brick_count * kBrickVoxels * sizeof(std::int32_t));
  layout.records = align(layout.columns + brick_count * sizeof(std::uint64_t));
  layout.bytes = layout.records + record_count * sizeof(VoxelRecord);
  return layout;
}

LayersLayout layers_layout(int size_xy) {
  LayersLayout layout{};
  layout.cells = static_cast<std::size_t>(size_xy) * static_cast<std::size_t>(size_xy);
  std::size_t end = sizeof(Layers);
  for (int i = 0; i < kLayers; ++i) {
    layout.offset[i] = align(end);
    end = layout.offset[i] + layout.cells * layer_value_bytes(static_cast<LayerId>(i));
  }
  layout.bytes = end;
  return layout;
}

}  // namespace gvom::ipc
