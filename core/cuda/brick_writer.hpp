// From dense bricks to the pair of lookup and data (R6) on the device, and to the host.
#pragma once

#include <cstdint>

#include "core/cuda/device.hpp"
#include "core/cuda/device_map.hpp"
#include "core/cuda/scan.hpp"

namespace gvom::cuda {

class BrickWriter {
 public:
  /// @param most_records that any map has
  BrickWriter(Device& device, const MapConfig& map, std::size_t most_records);

  /// Measures the map of a grid; `shape` is known when the device has waited.
  void measure(const DenseBricks& bricks, const Grid& grid);
  [[nodiscard]] BrickMapShape shape() const;

  /// The map's lowest rays (R5a) on the device: for who knows them to fill in before `write`.
  [[nodiscard]] float* lowest_ray_m() const { return made_.lowest_ray_m; }

  /// Sends the measured map to `out`; the bricks must be what they were.
  void write(const BrickMapArrays& out);

 private:
  Device& device_;
  std::uint32_t slots_;
  std::uint32_t columns_;  // of the grid
  std::size_t most_records_;
  Scan scan_;
  DenseBricks bricks_{};
  Grid grid_;
  std::uint8_t* observed_;  // [slot][column], bit z: the voxel was observed, has hits
  std::uint8_t* hit_;
  std::uint64_t* sizes_;   // [slot + 1]: 1 << 32 for a brick, plus its records
  std::uint64_t* starts_;  // their running sum
  std::uint64_t* total_;   // pinned
  BrickMapArrays made_;    // on the device
};

}  // namespace gvom::cuda
