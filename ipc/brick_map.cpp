#include "ipc/brick_map.hpp"

#include <cstring>
#include <utility>

#include "ipc/text.hpp"

namespace gvom::ipc {
namespace {

template <typename T>
Span<T> array_at(std::byte* base, std::size_t offset, std::size_t count) {
  return {reinterpret_cast<T*>(base + offset), count};
}

template <typename T>
Span<const T> array_at(const std::byte* base, std::size_t offset, std::size_t count) {
  return {reinterpret_cast<const T*>(base + offset), count};
}

BrickMapLayout layout_of(const BrickMap& map) {
  return brick_map_layout(map.shape);
}

std::size_t lookup_count(std::uint32_t brick_count) {
  return std::size_t{brick_count} * kBrickCells;
}

/// The bytes between the arrays would else carry an older message's.
void zero_padding(std::byte* base, const BrickMap& map, const BrickMapLayout& layout) {
  const auto zero = [base](std::size_t from, std::size_t to) { std::memset(base + from, 0, to - from); };
  zero(layout.directory + map.shape.brick_slots * sizeof(std::int32_t), layout.lookup);
  zero(layout.lookup + lookup_count(map.shape.brick_count) * sizeof(std::int32_t), layout.columns);
  zero(layout.columns + map.shape.brick_count * sizeof(std::uint64_t), layout.lowest_ray);
  zero(layout.lowest_ray + map.shape.column_count * sizeof(float), layout.records);
}

}  // namespace

Span<std::int32_t> BrickMapWriter::directory() const {
  return array_at<std::int32_t>(loan_.data(), layout_.directory, header().shape.brick_slots);
}
Span<std::int32_t> BrickMapWriter::lookup() const {
  return array_at<std::int32_t>(loan_.data(), layout_.lookup, lookup_count(header().shape.brick_count));
}
Span<std::uint64_t> BrickMapWriter::columns() const {
  return array_at<std::uint64_t>(loan_.data(), layout_.columns, header().shape.brick_count);
}
Span<float> BrickMapWriter::lowest_ray_m() const {
  return array_at<float>(loan_.data(), layout_.lowest_ray, header().shape.column_count);
}
Span<VoxelRecord> BrickMapWriter::records() const {
  return array_at<VoxelRecord>(loan_.data(), layout_.records, header().shape.record_count);
}

BrickMapArrays BrickMapWriter::arrays() const {
  return {directory().data(), lookup().data(), columns().data(), lowest_ray_m().data(), records().data()};
}

BrickMapPublisher::BrickMapPublisher(OutPort port, std::string lidar, std::size_t capacity_bytes)
    : port_(std::move(port)), lidar_(std::move(lidar)), capacity_bytes_(capacity_bytes) {}

Expected<BrickMapPublisher> BrickMapPublisher::buffer_map(Runtime& runtime, const std::string& lidar,
                                                          std::size_t capacity_bytes) {
  const auto topic = buffer_map_topic(lidar);
  if (!topic) return tl::unexpected(topic.error());
  return OutPort::open(runtime, *topic).map([&](OutPort&& port) {
    return BrickMapPublisher(std::move(port), lidar, capacity_bytes);
  });
}

Expected<BrickMapPublisher> BrickMapPublisher::voxel_map(Runtime& runtime, std::size_t capacity_bytes) {
  return OutPort::open(runtime, voxel_map_topic()).map([&](OutPort&& port) {
    return BrickMapPublisher(std::move(port), "", capacity_bytes);
  });
}

Expected<BrickMapWriter> BrickMapPublisher::loan(const BrickMapShape& shape) {
  const BrickMapLayout layout = brick_map_layout(shape);
  if (layout.bytes > capacity_bytes_) {
    return tl::unexpected(Error{ErrorKind::too_large, "a map of " + std::to_string(layout.bytes) +
                                                          " bytes is beyond the capacity of " +
                                                          std::to_string(capacity_bytes_)});
  }
  // Always a chunk of the full capacity: a smaller loan would drain another topic's pool.
  return port_.loan(capacity_bytes_).map([&](Loan&& loan) {
    auto& map = *reinterpret_cast<BrickMap*>(loan.data());
    std::memset(loan.data(), 0, layout.directory);
    set_text(map.lidar, lidar_);
    map.shape = shape;
    zero_padding(loan.data(), map, layout);
    return BrickMapWriter(std::move(loan), layout);
  });
}

std::uint64_t BrickMapPublisher::publish(BrickMapWriter&& writer, std::int64_t stamp_ns,
                                         std::uint64_t epoch) {
  writer.header().mono_published_ns = monotonic_ns();
  return port_.publish(std::move(writer.loan_), writer.layout_.bytes, stamp_ns, epoch);
}

BrickMapSample::BrickMapSample(Chunk chunk) : chunk_(std::move(chunk)), layout_(layout_of(header())) {}

Span<const std::int32_t> BrickMapSample::directory() const {
  return array_at<std::int32_t>(chunk_.data(), layout_.directory, header().shape.brick_slots);
}
Span<const std::int32_t> BrickMapSample::lookup() const {
  return array_at<std::int32_t>(chunk_.data(), layout_.lookup, lookup_count(header().shape.brick_count));
}
Span<const std::uint64_t> BrickMapSample::columns() const {
  return array_at<std::uint64_t>(chunk_.data(), layout_.columns, header().shape.brick_count);
}
Span<const float> BrickMapSample::lowest_ray_m() const {
  return array_at<float>(chunk_.data(), layout_.lowest_ray, header().shape.column_count);
}
Span<const VoxelRecord> BrickMapSample::records() const {
  return array_at<VoxelRecord>(chunk_.data(), layout_.records, header().shape.record_count);
}

BrickMapView BrickMapSample::view() const {
  const BrickMap& map = header();
  return {map.grid,           map.header.stamp_ns,
          map.T_odom_base,    map.shape,
          directory().data(), lookup().data(),
          columns().data(),   lowest_ray_m().data(),
          records().data(),   layout_.bytes - layout_.directory};
}

Expected<BrickMapSubscriber> BrickMapSubscriber::buffer_map(Runtime& runtime, const std::string& lidar) {
  const auto topic = buffer_map_topic(lidar);
  if (!topic) return tl::unexpected(topic.error());
  return InPort::open(runtime, *topic).map([](InPort&& port) { return BrickMapSubscriber(std::move(port)); });
}

Expected<BrickMapSubscriber> BrickMapSubscriber::voxel_map(Runtime& runtime) {
  return InPort::open(runtime, voxel_map_topic()).map([](InPort&& port) {
    return BrickMapSubscriber(std::move(port));
  });
}

std::optional<BrickMapSample> BrickMapSubscriber::take() {
  auto chunk = port_.take();
  if (!chunk) return std::nullopt;
  return BrickMapSample(std::move(*chunk));
}

}  // namespace gvom::ipc
