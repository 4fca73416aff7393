// Memory for maps and layers as the bus has it: arrays behind each other, each aligned to 64 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/format/brick_map.hpp"
#include "core/format/layers.hpp"
#include "core/open_backend.hpp"

namespace gvom::bench {

/// One piece of memory, of whole pages, zero at first.
class Memory {
 public:
  Memory() = default;
  explicit Memory(std::size_t bytes) : pages_((bytes + sizeof(Page) - 1) / sizeof(Page)) {}

  [[nodiscard]] std::byte* begin() { return pages_.empty() ? nullptr : pages_.front().bytes; }
  [[nodiscard]] HostMemory whole() { return {begin(), pages_.size() * sizeof(Page)}; }

 private:
  struct alignas(4096) Page {
    std::byte bytes[4096];
  };
  std::vector<Page> pages_;
};

/// A buffer map in memory of its own.
struct OwnedMap {
  Memory memory;
  BrickMapView view;
};

/// Room for a map, bytes; a multiple of 64.
std::size_t map_bytes(const BrickMapShape& shape);
/// The arrays of a map at `begin`.
BrickMapArrays map_arrays(std::byte* begin, const BrickMapShape& shape);
/// `what` with these arrays, which lie in one piece.
BrickMapView map_in_one(const BrickMapView& what, const BrickMapArrays& arrays);
/// A copy of a map that lies in one piece, at `begin`.
BrickMapView copy_map(const BrickMapView& from, std::byte* begin);

/// Room for all layers, bytes; a multiple of 64.
std::size_t layers_bytes(std::size_t columns);
/// The layers at `begin`.
LayerArrays layer_arrays(std::byte* begin, std::size_t columns);

}  // namespace gvom::bench
