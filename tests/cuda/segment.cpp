#include "tests/cuda/segment.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace gvom::test {

namespace {

constexpr int kNonsense = 0x6E;

constexpr std::size_t kPage = 4096;

std::size_t aligned(std::size_t bytes, std::size_t to = 64) {
  return (bytes + to - 1) / to * to;
}

}  // namespace

Segment::Segment(std::size_t bytes)
    : memory_(aligned(bytes, kPage) + kPage),
      begin_(reinterpret_cast<std::byte*>(aligned(reinterpret_cast<std::uintptr_t>(memory_.data()), kPage))),
      bytes_(aligned(bytes, kPage)) {}

// The first gap that is large enough.
std::byte* Segment::take(std::size_t bytes) {
  std::byte* next = begin_;
  for (const auto& [begin, size] : taken_) {
    if (static_cast<std::size_t>(begin - next) >= bytes) break;
    next = begin + aligned(size);
  }
  if (next + bytes > begin_ + bytes_) throw std::length_error("the segment is full");
  taken_[next] = bytes;
  std::memset(next, kNonsense, bytes);
  return next;
}

void Segment::give_back(const void* begin) {
  const auto chunk = taken_.find(static_cast<std::byte*>(const_cast<void*>(begin)));
  std::memset(chunk->first, kNonsense, chunk->second);
  taken_.erase(chunk);
}

BrickMapArrays Segment::loan_map(const BrickMapShape& shape, BrickMapView& view) {
  const BrickMapLayout layout = brick_map_layout(0, shape);
  std::byte* const chunk = take(layout.bytes);
  const BrickMapArrays arrays{reinterpret_cast<std::int32_t*>(chunk + layout.directory),
                              reinterpret_cast<std::int32_t*>(chunk + layout.lookup),
                              reinterpret_cast<std::uint64_t*>(chunk + layout.columns),
                              reinterpret_cast<float*>(chunk + layout.lowest_ray),
                              reinterpret_cast<VoxelRecord*>(chunk + layout.records)};
  view.shape = shape;
  view.directory = arrays.directory;
  view.lookup = arrays.lookup;
  view.columns = arrays.columns;
  view.lowest_ray_m = arrays.lowest_ray_m;
  view.records = arrays.records;
  view.bytes_in_one = layout.bytes;
  return arrays;
}

LayerArrays Segment::loan_layers(int size_xy) {
  const std::size_t columns = static_cast<std::size_t>(size_xy) * static_cast<std::size_t>(size_xy);
  const std::size_t floats = aligned(columns * sizeof(float)), bytes = aligned(columns);
  std::byte* const chunk = take(10 * floats + 2 * bytes + columns);
  const auto f = [&](std::size_t i) { return reinterpret_cast<float*>(chunk + i * floats); };
  const auto b = [&](std::size_t i) {
    return reinterpret_cast<std::uint8_t*>(chunk + 10 * floats + i * bytes);
  };
  return {f(0), f(1), f(2), f(3), f(4), f(5), f(6),
          f(7), f(8), f(9), b(0), b(1), b(2), 10 * floats + 2 * bytes + columns};
}

}  // namespace gvom::test
