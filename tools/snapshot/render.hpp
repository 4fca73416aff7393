// From layers to pictures that a person understands: all of them in one montage, or one layer alone.
#pragma once

#include "tools/snapshot/canvas.hpp"
#include "tools/snapshot/panel.hpp"
#include "tools/snapshot/picture.hpp"

namespace gvom::snapshot {

/// Where a map of columns lies on a canvas. Every column is a block of `zoom` x `zoom` pixels; +y is up.
struct MapArea {
  int left = 0;
  int top = 0;
  int n_xy = 0;
  int zoom = 1;

  [[nodiscard]] int size_px() const { return n_xy * zoom; }
  /// The upper left pixel of a column's block.
  [[nodiscard]] int column_left(int x) const { return left + x * zoom; }
  [[nodiscard]] int column_top(int y) const { return top + (n_xy - 1 - y) * zoom; }
};

/// Where `render_layer` puts the map of a grid of `n_xy` columns.
MapArea layer_map_area(int n_xy);

/// Twelve panels, 4 x 3, under a header.
Canvas render_montage(const LayersPicture& picture);

/// The ground as each lidar sees it, from the side and from behind, against where the vehicle's file puts it,
/// and the layers' heights there. For each lidar a row.
Canvas render_ground(const LayersPicture& picture);

/// One panel, large, under a header.
Canvas render_layer(const LayersPicture& picture, const Panel& panel);

}  // namespace gvom::snapshot
