// A map in memory of its own, aligned as chunks are.
#pragma once

#include <algorithm>
#include <vector>

#include "ipc/brick_map.hpp"
#include "ipc/layout.hpp"

namespace gvom::ipc::test {

/// A grid of 16 x 16 x 8 voxels. Slots 1 and 3 have bricks with one record each; beside it a voxel was
/// passed.
class TwoBricks {
 public:
  explicit TwoBricks(std::uint32_t brick_count = 2, std::uint32_t record_count = 2)
      : layout_(brick_map_layout({4, brick_count, record_count, kColumns})),
        memory_(layout_.bytes / sizeof(Line) + 1) {
    BrickMap& map = header();
    map.header.magic = kMagic;
    map.header.type = static_cast<std::uint16_t>(MessageType::buffer_map);
    map.header.version = BrickMap::kVersion;
    map.header.size = layout_.bytes;
    map.grid.size[0] = map.grid.size[1] = 16;
    map.grid.size[2] = 8;
    map.grid.resolution_m = {0.4, 0.4, 0.4};
    map.T_odom_base.orientation_xyzw[3] = 1;
    map.shape = {4, brick_count, record_count, kColumns};
    std::fill_n(lowest_ray_m(), kColumns, kNoRay_m);
    std::fill_n(directory(), map.shape.brick_slots, -1);
    std::fill_n(lookup(), brick_count * kBrickCells, -1);
    for (std::uint32_t brick = 0; brick < brick_count; ++brick) {
      directory()[2 * brick + 1] = static_cast<std::int32_t>(brick);
      lookup()[brick * kBrickCells + 3] = static_cast<std::int32_t>(brick);
      lookup()[brick * kBrickCells + 4] = -2;
      columns()[brick] = 1;
      records()[brick] = {1, 0, 0.5F};
    }
  }

  [[nodiscard]] std::byte* data() { return reinterpret_cast<std::byte*>(memory_.data()); }
  [[nodiscard]] std::size_t bytes() const { return layout_.bytes; }
  [[nodiscard]] BrickMap& header() { return *reinterpret_cast<BrickMap*>(data()); }
  [[nodiscard]] std::int32_t* directory() { return at<std::int32_t>(layout_.directory); }
  [[nodiscard]] std::int32_t* lookup() { return at<std::int32_t>(layout_.lookup); }
  [[nodiscard]] std::uint64_t* columns() { return at<std::uint64_t>(layout_.columns); }
  [[nodiscard]] float* lowest_ray_m() { return at<float>(layout_.lowest_ray); }
  [[nodiscard]] VoxelRecord* records() { return at<VoxelRecord>(layout_.records); }
  [[nodiscard]] BrickMapSample sample() { return BrickMapSample(Chunk(nullptr, data())); }

 private:
  static constexpr std::uint32_t kColumns = 256;

  struct alignas(kArrayAlignment) Line {
    std::byte bytes[kArrayAlignment];
  };
  template <typename T>
  T* at(std::size_t offset) {
    return reinterpret_cast<T*>(data() + offset);
  }

  BrickMapLayout layout_;
  std::vector<Line> memory_;
};

}  // namespace gvom::ipc::test
