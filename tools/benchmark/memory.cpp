#include "tools/benchmark/memory.hpp"

#include <cstring>

namespace gvom::bench {

namespace {

constexpr std::size_t kFloatLayers = 10;
constexpr std::size_t kByteLayers = 3;

}  // namespace

std::size_t map_bytes(const BrickMapShape& shape) {
  return align_array(brick_map_layout(0, shape).bytes);
}

BrickMapArrays map_arrays(std::byte* begin, const BrickMapShape& shape) {
  const BrickMapLayout layout = brick_map_layout(0, shape);
  return {reinterpret_cast<std::int32_t*>(begin), reinterpret_cast<std::int32_t*>(begin + layout.lookup),
          reinterpret_cast<std::uint64_t*>(begin + layout.columns),
          reinterpret_cast<float*>(begin + layout.lowest_ray),
          reinterpret_cast<VoxelRecord*>(begin + layout.records)};
}

BrickMapView copy_map(const BrickMapView& from, std::byte* begin) {
  std::memcpy(begin, from.directory, from.bytes_in_one);
  return map_in_one(from, map_arrays(begin, from.shape));
}

BrickMapView map_in_one(const BrickMapView& what, const BrickMapArrays& arrays) {
  BrickMapView map = what;
  map.directory = arrays.directory;
  map.lookup = arrays.lookup;
  map.columns = arrays.columns;
  map.lowest_ray_m = arrays.lowest_ray_m;
  map.records = arrays.records;
  map.bytes_in_one = map_bytes(what.shape);
  return map;
}

std::size_t layers_bytes(std::size_t columns) {
  return kFloatLayers * align_array(columns * sizeof(float)) + kByteLayers * align_array(columns);
}

LayerArrays layer_arrays(std::byte* begin, std::size_t columns) {
  const std::size_t float_bytes = align_array(columns * sizeof(float));
  const auto f = [&](std::size_t i) { return reinterpret_cast<float*>(begin + i * float_bytes); };
  const auto b = [&](std::size_t i) {
    return reinterpret_cast<std::uint8_t*>(begin + kFloatLayers * float_bytes + i * align_array(columns));
  };
  return {f(0), f(1), f(2), f(3), f(4), f(5), f(6),
          f(7), f(8), f(9), b(0), b(1), b(2), layers_bytes(columns)};
}

}  // namespace gvom::bench
