// Where the arrays of a message lie behind its header: pure arithmetic, bytes from the message's start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/messages.hpp"

namespace gvom::ipc {

/// Arrays of a BrickMap.
inline BrickMapLayout brick_map_layout(const BrickMapShape& shape) {
  return gvom::brick_map_layout(sizeof(BrickMap), shape);
}

/// Arrays of Layers: `offset[LayerId]`, each of `cells` = size_xy * size_xy values.
struct LayersLayout {
  std::array<std::size_t, kLayers> offset;
  std::size_t cells;
  std::size_t bytes;  ///< Of the whole message.
};

LayersLayout layers_layout(int size_xy);

/// Whole messages, bytes.
inline std::size_t brick_map_bytes(const BrickMapShape& shape) {
  return brick_map_layout(shape).bytes;
}
inline std::size_t layers_bytes(int size_xy) {
  return layers_layout(size_xy).bytes;
}

}  // namespace gvom::ipc
