#include "ipc/topic.hpp"

#include <algorithm>
#include <string_view>

#include "ipc/layout.hpp"

namespace gvom::ipc {
namespace {

constexpr int kMaxGridVoxels = 4096;  // an edge; far beyond any configuration, far below overflow
constexpr char kAll[] = "all";

using Complaint = std::optional<std::string>;

template <typename M>
const M& as(const std::byte* message) {
  return *reinterpret_cast<const M*>(message);
}

Complaint wrong_size(std::size_t bytes, std::size_t expected) {
  if (bytes == expected) return std::nullopt;
  return "is " + std::to_string(bytes) + " bytes long, expected " + std::to_string(expected);
}

Complaint too_many(const char* what, std::uint64_t count, std::uint64_t limit) {
  if (count <= limit) return std::nullopt;
  return "claims " + std::to_string(count) + " " + what + ", at most " + std::to_string(limit) + " can be";
}

Complaint first_of(Complaint a, Complaint b) {
  return a ? std::move(a) : std::move(b);
}

bool is_grid_edge(std::int32_t size) {
  return size > 0 && size <= kMaxGridVoxels && size % kBrickEdgeVoxels == 0;
}

Complaint bad_grid(const std::int32_t (&size)[3]) {
  if (size[0] == size[1] && is_grid_edge(size[0]) && is_grid_edge(size[2])) return std::nullopt;
  return "claims a grid of " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
         std::to_string(size[2]) + " voxels";
}

Complaint check_odometry(const std::byte*, std::size_t bytes) {
  return wrong_size(bytes, sizeof(Odometry));
}

Complaint check_progress(const std::byte* message, std::size_t bytes) {
  if (auto complaint = wrong_size(bytes, sizeof(Progress))) return complaint;
  return too_many("lidars", as<Progress>(message).lidar_count, kMaxLidars);
}

Complaint check_health(const std::byte* message, std::size_t bytes) {
  if (auto complaint = wrong_size(bytes, sizeof(Health))) return complaint;
  const auto& health = as<Health>(message);
  return first_of(too_many("counters", health.counter_count, Health::kMaxCounters),
                  too_many("stages", health.stage_count, Health::kMaxStages));
}

Complaint check_layers(const std::byte* message, std::size_t bytes) {
  if (bytes < sizeof(Layers)) return wrong_size(bytes, sizeof(Layers));
  const auto& layers = as<Layers>(message);
  if (auto complaint = bad_grid(layers.size_voxels)) return complaint;
  return first_of(too_many("lidars", layers.lidar_count, kMaxLidars),
                  wrong_size(bytes, layers_bytes(layers.size_voxels[0])));
}

Complaint check_brick_map(const std::byte* message, std::size_t bytes) {
  if (bytes < sizeof(BrickMap)) return wrong_size(bytes, sizeof(BrickMap));
  const auto& map = as<BrickMap>(message);
  const auto& size = map.size_voxels;
  if (auto complaint = bad_grid(size)) return complaint;
  const std::uint64_t voxels = std::uint64_t(size[0]) * std::uint64_t(size[1]) * std::uint64_t(size[2]);
  if (map.brick_slots != voxels / kBrickVoxels) {
    return "claims " + std::to_string(map.brick_slots) + " brick slots, its grid has " +
           std::to_string(voxels / kBrickVoxels);
  }
  if (auto complaint = too_many("bricks", map.brick_count, map.brick_slots)) return complaint;
  return first_of(too_many("records", map.record_count, map.brick_count * std::uint64_t{kBrickVoxels}),
                  wrong_size(bytes, brick_map_bytes(map.brick_slots, map.brick_count, map.record_count)));
}

bool is_lidar_name(std::string_view name) {
  return !name.empty() && name.size() < kNameLength && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

template <>
Topic topic_of<Odometry>() {
  return {"odometry", kAll, Odometry::kType, Odometry::kVersion, check_odometry, kOdometryQueue};
}

template <>
Topic topic_of<Progress>() {
  return {"progress", kAll, Progress::kType, Progress::kVersion, check_progress, kProgressQueue};
}

template <>
Topic topic_of<Health>() {
  return {"health", kAll, Health::kType, Health::kVersion, check_health, kHealthQueue};
}

Topic layers_topic() {
  return {"layers", kAll, Layers::kType, Layers::kVersion, check_layers, kLayersQueue, kLayersHistory};
}

Topic voxel_map_topic() {
  return {"voxel_map", kAll, MessageType::voxel_map, BrickMap::kVersion, check_brick_map, kVoxelMapQueue};
}

Expected<Topic> buffer_map_topic(const std::string& lidar) {
  if (!is_lidar_name(lidar)) {
    return tl::unexpected(
        Error{ErrorKind::bad_name, "lidar name '" + lidar + "': expected 1 to 31 of [a-z0-9_]"});
  }
  return Topic{"buffer_map",       lidar,           MessageType::buffer_map,
               BrickMap::kVersion, check_brick_map, kBufferMapQueue};
}

}  // namespace gvom::ipc
