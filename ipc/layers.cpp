#include "ipc/layers.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "ipc/freshness.hpp"
#include "ipc/text.hpp"

namespace gvom::ipc {
namespace {

bool is_float(LayerId id) {
  return static_cast<int>(id) < kFloatLayers;
}

std::size_t offset_of(const LayersLayout& layout, LayerId id) {
  return layout.offset[static_cast<std::size_t>(id)];
}

/// The bytes between the arrays would else carry an older message's.
void zero_padding(std::byte* base, const LayersLayout& layout) {
  for (int i = 0; i + 1 < kLayers; ++i) {
    const std::size_t end = layout.offset[i] + layout.cells * layer_value_bytes(static_cast<LayerId>(i));
    std::memset(base + end, 0, layout.offset[i + 1] - end);
  }
}

}  // namespace

Span<float> LayersWriter::layer_f(LayerId id) const {
  if (!is_float(id)) return {};
  return {reinterpret_cast<float*>(loan_.data() + offset_of(layout_, id)), layout_.cells};
}

Span<std::uint8_t> LayersWriter::layer_u8(LayerId id) const {
  if (is_float(id)) return {};
  return {reinterpret_cast<std::uint8_t*>(loan_.data() + offset_of(layout_, id)), layout_.cells};
}

LayerArrays LayersWriter::arrays() const {
  const auto f = [this](LayerId id) { return layer_f(id).data(); };
  const auto u8 = [this](LayerId id) { return layer_u8(id).data(); };
  return {f(LayerId::height),
          f(LayerId::inferred_height),
          f(LayerId::slope_x),
          f(LayerId::slope_y),
          f(LayerId::slope),
          f(LayerId::roughness),
          f(LayerId::obstacle_density),
          f(LayerId::negative_delta),
          f(LayerId::clearance),
          f(LayerId::last_seen),
          u8(LayerId::flags),
          u8(LayerId::visibility),
          u8(LayerId::cost),
          layout_.bytes - layout_.offset.front()};
}

Expected<LayersPublisher> LayersPublisher::open(Runtime& runtime) {
  return OutPort::open(runtime, layers_topic()).map([](OutPort&& port) {
    return LayersPublisher(std::move(port));
  });
}

Expected<LayersWriter> LayersPublisher::loan(int size_xy, int size_z) {
  const LayersLayout layout = layers_layout(size_xy);
  return port_.loan(layout.bytes).map([&](Loan&& loan) {
    std::memset(loan.data(), 0, layout.offset.front());
    zero_padding(loan.data(), layout);
    LayersWriter writer(std::move(loan), layout);
    auto& size = writer.header().grid.size;
    size[0] = size[1] = size_xy;
    size[2] = size_z;
    return writer;
  });
}

std::uint64_t LayersPublisher::publish(LayersWriter&& writer, std::int64_t stamp_ns, std::uint64_t epoch) {
  writer.header().mono_published_ns = monotonic_ns();
  return port_.publish(std::move(writer.loan_), writer.layout_.bytes, stamp_ns, epoch);
}

LayersSample::LayersSample(Chunk chunk) : chunk_(std::move(chunk)), layout_(layers_layout(size_xy())) {}

Span<const float> LayersSample::layer_f(LayerId id) const {
  if (!is_float(id)) return {};
  return {reinterpret_cast<const float*>(chunk_.data() + offset_of(layout_, id)), layout_.cells};
}

Span<const std::uint8_t> LayersSample::layer_u8(LayerId id) const {
  if (is_float(id)) return {};
  return {reinterpret_cast<const std::uint8_t*>(chunk_.data() + offset_of(layout_, id)), layout_.cells};
}

std::optional<std::size_t> LayersSample::index_of(double x_m, double y_m) const {
  const Layers& layers = header();
  const auto column = [&layers](double metres, std::size_t axis) {
    return std::floor(voxel_coordinate(metres, layers.grid.resolution_m[axis])) - layers.grid.origin[axis];
  };
  const double x = column(x_m, 0);
  const double y = column(y_m, 1);
  const bool inside = x >= 0 && y >= 0 && x < size_xy() && y < size_xy();
  if (!inside) return std::nullopt;
  return at(static_cast<int>(x), static_cast<int>(y));
}

std::chrono::nanoseconds LayersSample::age() const {
  return elapsed(received_at(header()), Moment::now());
}

std::chrono::nanoseconds LayersSample::publish_age() const {
  return stage_ages().published;
}

StageAges LayersSample::stage_ages() const {
  const std::int64_t now = monotonic_ns();
  const auto age = [now](std::int64_t mono_ns) {
    return std::chrono::nanoseconds(mono_ns == 0 ? -1 : now - mono_ns);
  };
  const Layers& layers = header();
  return {age(layers.mono_received_ns), age(layers.mono_mapped_ns), age(layers.mono_map_published_ns),
          age(layers.mono_fused_ns), age(layers.mono_published_ns)};
}

std::vector<std::string> LayersSample::missing_lidars() const {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < header().lidar_count; ++i) {
    const LidarStatus& lidar = header().lidars[i];
    if (lidar.missing != 0) names.emplace_back(text_of(lidar.name));
  }
  return names;
}

std::vector<LayersSample::IncompleteLidar> LayersSample::incomplete_lidars() const {
  std::vector<IncompleteLidar> incomplete;
  for (std::uint32_t i = 0; i < header().lidar_count; ++i) {
    const LidarStatus& lidar = header().lidars[i];
    const bool came = lidar.newest_stamp_ns != 0;
    if (came && lidar.columns_seen_fraction < 1)
      incomplete.push_back({std::string(text_of(lidar.name)), lidar.columns_seen_fraction});
  }
  return incomplete;
}

Expected<LayersSubscriber> LayersSubscriber::open(Runtime& runtime) {
  return InPort::open(runtime, layers_topic()).map([](InPort&& port) {
    return LayersSubscriber(std::move(port));
  });
}

std::optional<LayersSample> LayersSubscriber::take() {
  auto chunk = port_.take();
  if (!chunk) return std::nullopt;
  return LayersSample(std::move(*chunk));
}

std::optional<LayersSample> LayersSubscriber::take_newest() {
  std::optional<LayersSample> newest = take();
  while (newest && port_.has_data()) {
    auto next = take();
    if (!next) break;
    newest = std::move(next);
  }
  return newest;
}

}  // namespace gvom::ipc
