#include "core/cuda/layer_maker.hpp"

#include <new>

#include "core/cuda/fill.hpp"
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

// Nothing is known in any of the columns, and never in the margin.
ColumnArrays column_arrays(Device& device, const ColumnGrid& grid) {
  const auto size = static_cast<std::size_t>(grid.size());
  const auto filled = [&](float value) {
    auto* const array = device.array<float>(size);
    for_each(device, grid.size(), Fill<float>{array, value});
    return array;
  };
  const auto zeros = [&](std::size_t bytes) {
    void* const array = device.allocate(bytes);
    device.clear(array, bytes);
    return array;
  };
  const auto flags = [&] { return static_cast<std::uint8_t*>(zeros(size)); };
  return {grid,
          filled(kNone_m),
          filled(kNone_m),
          filled(kNone_m),
          filled(kNone_m),
          filled(kUnknown),
          flags(),
          flags(),
          static_cast<std::int8_t*>(zeros(size)),
          static_cast<std::int8_t*>(zeros(size)),
          flags(),
          static_cast<ObstacleSums*>(zeros(size * sizeof(ObstacleSums))),
          flags()};
}

AllowedRises allowed_rises(double resolution_m) {
  AllowedRises rises{};
  for (std::int32_t line = 0; line < kLines; ++line)
    for (std::int32_t d = 1; d <= kSides; ++d)
      rises.over_sides_m[line][d - 1] = allowed_rise_m(line, d, resolution_m);
  for (std::int32_t d = 0; d <= kConeReach; ++d) rises.cone_m[d] = cone_rise_m(d, resolution_m);
  return rises;
}

}  // namespace

LayerMaker::LayerMaker(Device& device, const MapperConfig& config)
    : device_(device),
      config_(config),
      most_bytes_(kFloatLayers * aligned(columns() * sizeof(float)) + kByteLayers * aligned(columns())),
      out_(device.array<std::byte>(most_bytes_)),
      columns_(column_arrays(device, ColumnGrid{config.map.size_xy})),
      tick_(device.array<LayerTick>(1)),
      staged_(device.pinned_array<LayerTick>(1)) {
  record();
}

void LayerMaker::record() {
  const auto n = static_cast<std::int32_t>(columns());
  const AllowedRises rises = allowed_rises(config_.map.resolution_xy_m);
  make_ = device_.record([this, n, rises] {
    for_each(device_, n, ReadColumns{tick_, columns_});
    for_each(device_, n, SpreadCones{columns_, rises});
    for_each(device_, n, FindRims{columns_, rises});
    for_each(device_, n, CountVotes{columns_});
    for_each(device_, n, DoubtGround{columns_});
    for_each(device_, n, WriteHeights{tick_, columns_});
    for_each(device_, n, JudgeColumns{tick_, columns_});
    for_each(device_, n, FinishColumns{tick_, columns_});
  });
}

std::size_t LayerMaker::columns() const {
  return static_cast<std::size_t>(config_.map.size_xy) * static_cast<std::size_t>(config_.map.size_xy);
}

void LayerMaker::make(const FusedView& view, const WindowMaps& window, const LayerMoment& moment,
                      const LayerArrays& out) {
  if (device_.failed()) return;
  if (out.bytes_in_one > most_bytes_) return device_.fail("layers are larger than there is room for");
  const ColumnParameters parameters = column_parameters(config_, moment);
  new (staged_) LayerTick{view, window, parameters, hole_parameters(parameters), on_device(out)};
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
