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
  explicit Segment(std::size_t bytes) : memory_(bytes + kAlignment) {}

  [[nodiscard]] HostMemory memory() { return {memory_.data(), memory_.size()}; }

  /// A chunk for a map, to be filled; `view` gets its pointers. Nothing is in it yet but nonsense.
  BrickMapArrays loan_map(const BrickMapShape& shape, BrickMapView& view);
  /// A chunk for layers of n * n columns.
  LayerArrays loan_layers(int size_xy);
  /// Gives the chunk that begins at `begin` back: it is filled with nonsense, as its next owner would.
  void give_back(const void* begin);

 private:
  static constexpr std::size_t kAlignment = 64;
  std::byte* take(std::size_t bytes);

  std::vector<std::byte> memory_;
  std::map<std::byte*, std::size_t> taken_;  // begin and bytes
};

}  // namespace gvom::test
