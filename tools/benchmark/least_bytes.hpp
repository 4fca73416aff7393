// The fewest bytes that a tick must move, whoever computes it: what its time is held against.
#pragma once

#include "core/format/layers.hpp"
#include "core/window.hpp"

namespace gvom::bench {

/// Of each stage, bytes.
struct LeastBytes {
  double upload = 0;
  double fuse = 0;
  double layers = 0;
  double download = 0;

  LeastBytes operator+(const LeastBytes& other) const {
    return {upload + other.upload, fuse + other.fuse, layers + other.layers, download + other.download};
  }
  LeastBytes operator/(double n) const { return {upload / n, fuse / n, layers / n, download / n}; }
};

/// How `least_bytes` counts, for people.
inline constexpr const char* kLeastBytesWords =
    "- upload: the map.\n"
    "- fuse: of the map that came and those that left, the directory is read, and the lookup values, "
    "observed columns and records of their bricks; of the bricks that they touch, 12 bytes a voxel (hits, "
    "passes, minimum) are read and written, 2 bits a voxel (occupied, free) written; of the columns through "
    "these, the last-seen stamp is read and written. Of the bricks that enter as the grid moves, 12 bytes a "
    "voxel are written, and what the window's other maps have there is read, but for their records.\n"
    "- layers: of each column, both masks, the stamp and the lowest ray are read, and hits, passes and "
    "minimum of its ground; each layer is written once.\n"
    "- download: the layers.\n";

/// Of the tick whose map `window` took last, the newest, and whose layers are `layers`.
/// @param before the grid of the tick before it
LeastBytes least_bytes(const Window& window, const Grid& before, const LayerArrays& layers);

}  // namespace gvom::bench
