// Memory as the bus has it: one segment, in which maps and layers are single chunks.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/backend.hpp"
#include "core/open_backend.hpp"

namespace gvom::test {

class Segment {
 public:
  /// @param bytes of which it has at least so many; whole pages, as what is pinned should be
  explicit Segment(std::size_t bytes);

  [[nodiscard]] HostMemory memory() { return {begin_, bytes_}; }

  /// A chunk for a map, to be filled; `view` gets its pointers. Nothing is in it yet but nonsense.
  BrickMapArrays loan_map(const BrickMapShape& shape, BrickMapView& view);
  /// A chunk for layers of n * n columns.
  LayerArrays loan_layers(int size_xy);
  /// Gives the chunk that begins at `begin` back: it is filled with nonsense, as its next owner would.
  void give_back(const void* begin);

 private:
  std::byte* take(std::size_t bytes);

  std::vector<std::byte> memory_;
  std::byte* begin_;
  std::size_t bytes_;
  std::map<std::byte*, std::size_t> taken_;  // begin and bytes
};

}  // namespace gvom::test
