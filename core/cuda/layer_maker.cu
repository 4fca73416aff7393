#include "core/cuda/layer_maker.hpp"

#include <new>

#include "core/cuda/launch.hpp"

namespace gvom::cuda {

namespace {

constexpr std::size_t kFloatLayers = 10;
constexpr std::size_t kByteLayers = 3;
constexpr std::size_t kAlignment = 256;

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// Calls `visit` with both sets' pointers, layer by layer.
template <class Visit>
void for_each_layer(const LayerArrays& a, LayerArrays& b, Visit&& visit) {
  visit(a.height, b.height), visit(a.inferred_height, b.inferred_height);
  visit(a.slope_x, b.slope_x), visit(a.slope_y, b.slope_y), visit(a.slope, b.slope);
  visit(a.roughness, b.roughness), visit(a.obstacle_density, b.obstacle_density);
  visit(a.negative_delta, b.negative_delta), visit(a.clearance, b.clearance);
  visit(a.last_seen, b.last_seen), visit(a.flags, b.flags);
  visit(a.visibility, b.visibility), visit(a.cost, b.cost);
}

}  // namespace

LayerMaker::LayerMaker(Device& device, const MapperConfig& config)
    : device_(device),
      config_(config),
      most_bytes_(kFloatLayers * aligned(columns() * sizeof(float)) + kByteLayers * aligned(columns())),
      out_(device.array<std::byte>(most_bytes_)),
      tick_(device.array<LayerTick>(1)),
      staged_(device.pinned_array<LayerTick>(1)) {
  const std::int32_t n = config.map.size_xy;
  const std::int32_t words = (n + 63) / 64;
  const std::size_t line_words = static_cast<std::size_t>(n) * static_cast<std::size_t>(words);
  const DefinedHeights defined{device.array<std::uint64_t>(line_words),
                               device.array<std::uint64_t>(line_words), words};
  auto* const along_x = device.array<std::int16_t>(columns());
  auto* const along_y = device.array<std::int16_t>(columns());
  make_ = device.record([=, &device] {
    for_each(device, n * n, ReadColumns{tick_});
    for_each_warp(device, 2 * n * 2 * words, MarkDefined{tick_, defined});
    for_each(device, n * n, FindNearest{defined, along_x, along_y, n});
    for_each(device, n * n, FinishColumns{tick_, {along_x, along_y}});
  });
}

std::size_t LayerMaker::columns() const {
  return static_cast<std::size_t>(config_.map.size_xy) * static_cast<std::size_t>(config_.map.size_xy);
}

void LayerMaker::make(const FusedView& view, const LayerMoment& moment, const LayerArrays& out) {
  if (device_.failed()) return;
  if (out.bytes_in_one > most_bytes_) return device_.fail("layers are larger than there is room for");
  new (staged_) LayerTick{view, column_parameters(config_, moment), on_device(out)};
  device_.upload(tick_, staged_, sizeof *staged_);
  device_.play(make_);
}

// The same offsets from `height` where the host's layers are one piece of memory.
LayerArrays LayerMaker::on_device(const LayerArrays& out) const {
  LayerArrays device{};
  std::byte* next = out_;
  for_each_layer(out, device, [&](auto* host, auto*& place) {
    std::byte* to = next;
    if (out.bytes_in_one > 0)
      to = out_ + (reinterpret_cast<std::byte*>(host) - reinterpret_cast<std::byte*>(out.height));
    place = reinterpret_cast<decltype(host)>(to);
    next += aligned(columns() * sizeof *host);
  });
  return device;
}

void LayerMaker::deliver(const LayerArrays& out) {
  bytes_delivered_ = kFloatLayers * columns() * sizeof(float) + kByteLayers * columns();
  if (out.bytes_in_one > 0) {
    bytes_delivered_ = out.bytes_in_one;
    return device_.download(out.height, out_, out.bytes_in_one);
  }
  LayerArrays made = on_device(out);
  for_each_layer(out, made,
                 [&](auto* host, auto* from) { device_.download(host, from, columns() * sizeof *host); });
}

}  // namespace gvom::cuda
