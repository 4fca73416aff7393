// What differs between maps, and between layers, array by array.
#pragma once

#include <string>

#include "core/format/brick_map.hpp"
#include "core/format/layers.hpp"
#include "tools/compare/difference.hpp"

namespace gvom::compare {

/// Of directory, lookup, columns, lowest rays and records; empty if nothing differs.
std::string map_difference(const BrickMapView& expected, const BrickMapView& found, Same same = Same::bytes);

/// Of all layers of `size_xy` * `size_xy` columns, indexed [y, x]; empty if nothing differs.
std::string layers_difference(const LayerArrays& expected, const LayerArrays& found, int size_xy,
                              Same same = Same::bytes);

}  // namespace gvom::compare
