// From the fused map to layers (R9..R16), column by column.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/format/layers.hpp"
#include "tests/oracle/fusion.hpp"

namespace gvom::oracle {

/// Layers in memory of their own, [y][x]. Filled with nonsense, so that a value never written is found.
struct Layers {
  explicit Layers(int size_xy);

  int n;
  std::vector<float> height, inferred_height, slope_x, slope_y, slope, roughness, obstacle_density,
      negative_delta, clearance, last_seen;
  std::vector<std::uint8_t> flags, visibility, cost;

  [[nodiscard]] std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(n) + std::size_t(x);
  }
  LayerArrays arrays();
};

/// @param min_hits of R8 is in the configuration; the window's newest map gives moment and pose
Layers make_layers(const MapperConfig& config, const Fusion& fusion);

/// The newest stamp of the window that observed each column, [y][x]; INT64_MIN where none did (R15).
std::vector<std::int64_t> newest_stamps(const Fusion& fusion);

}  // namespace gvom::oracle
