#include "ipc/layout.hpp"

namespace gvom::ipc {

LayersLayout layers_layout(int size_xy) {
  LayersLayout layout{};
  layout.cells = static_cast<std::size_t>(size_xy) * static_cast<std::size_t>(size_xy);
  std::size_t end = sizeof(Layers);
  for (int i = 0; i < kLayers; ++i) {
    layout.offset[i] = align_array(end);
    end = layout.offset[i] + layout.cells * layer_value_bytes(static_cast<LayerId>(i));
  }
  layout.bytes = end;
  return layout;
}

}  // namespace gvom::ipc
