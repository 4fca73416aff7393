// From the fused map to layers (R9..R16) on the device, and to the host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/cuda/device.hpp"
#include "core/cuda/layer_kernels.hpp"
#include "core/window.hpp"

namespace gvom::cuda {

class LayerMaker {
 public:
  LayerMaker(Device& device, const MapperConfig& config);

  /// Computes all layers; `deliver` sends them to the same arrays. `view` has the device's pointers; it is
  /// the sum of `window`.
  void make(const FusedView& view, const WindowMaps& window, const LayerMoment& moment,
            const LayerArrays& out);
  void deliver(const LayerArrays& out);

  /// Bytes of the last delivery.
  [[nodiscard]] std::uint64_t bytes_delivered() const { return bytes_delivered_; }

 private:
  [[nodiscard]] LayerArrays on_device(const LayerArrays& out) const;
  [[nodiscard]] std::size_t columns() const;
  void record();

  Device& device_;
  MapperConfig config_;
  std::size_t most_bytes_;
  std::byte* out_;  // where the layers are made
  ColumnArrays columns_;
  LayerTick* tick_;
  LayerTick* staged_;  // pinned
  Device::Graph make_;
  std::uint64_t bytes_delivered_ = 0;
};

}  // namespace gvom::cuda
