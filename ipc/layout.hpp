// Where the arrays of a message lie behind its header: pure arithmetic, bytes from the message's start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/messages.hpp"

namespace gvom::ipc {

inline constexpr int kBrickEdgeVoxels = 8;
inline constexpr std::size_t kBrickVoxels = 512;

/// Arrays of a BrickMap.
struct BrickMapLayout {
  std::size_t directory;
  std::size_t lookup;
  std::size_t columns;
  std::size_t records;
  std::size_t bytes;  ///< Of the whole message.
};

BrickMapLayout brick_map_layout(std::uint32_t brick_slots, std::uint32_t brick_count,
                                std::uint32_t record_count);

/// Arrays of Layers: `offset[LayerId]`, each of `cells` = size_xy * size_xy values.
struct LayersLayout {
  std::array<std::size_t, kLayers> offset;
  std::size_t cells;
  std::size_t bytes;  ///< Of the whole message.
};

LayersLayout layers_layout(int size_xy);

/// Whole messages, bytes.
inline std::size_t brick_map_bytes(std::uint32_t brick_slots, std::uint32_t brick_count,
                                   std::uint32_t record_count) {
  return brick_map_layout(brick_slots, brick_count, record_count).bytes;
}
inline std::size_t layers_bytes(int size_xy) {
  return layers_layout(size_xy).bytes;
}

/// 4 for float layers (height .. last_seen), 1 for the others.
inline std::size_t layer_value_bytes(LayerId id) {
  return static_cast<int>(id) < kFloatLayers ? sizeof(float) : sizeof(std::uint8_t);
}

}  // namespace gvom::ipc
