#include "ipc/topic.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <string_view>

#include "ipc/layout.hpp"

namespace gvom::ipc {
namespace {

constexpr int kMaxGridVoxels = 4096;  // an edge; far beyond any configuration, far below overflow
constexpr std::int32_t kMaxOriginVoxels = 1 << 30;  // 10,700 km in voxels of 1 cm
constexpr double kFarthest_m = 1e7;                 // as odometry is used; heights of it fit a float
constexpr std::int64_t kMaxStamp_ns = 4'000'000'000'000'000'000;  // the year 2096; sums and differences fit
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

/// Grows with each kVersion that is raised.
struct FormerVersion {
  MessageType type;
  std::uint16_t version;
  const char* release;  // the last that had it
};
constexpr FormerVersion kFormerVersions[] = {
    {MessageType::buffer_map, 1, "0.1"}, {MessageType::buffer_map, 2, "0.2"},
    {MessageType::voxel_map, 1, "0.1"},  {MessageType::voxel_map, 2, "0.2"},
    {MessageType::layers, 1, "0.2"},     {MessageType::health, 1, "0.1"},
    {MessageType::health, 2, "0.2"},
};

std::string release_of(const Topic& topic, std::uint16_t version) {
  for (const FormerVersion& former : kFormerVersions)
    if (former.type == topic.type && former.version == version) return std::string("gvom ") + former.release;
  return version > topic.version ? "a newer gvom" : "no known gvom";
}

std::string other_version(const Topic& topic, std::uint16_t version) {
  return "message of " + release_of(topic, version) + " (version " + std::to_string(version) +
         ") refused, this is " + release() + " (version " + std::to_string(topic.version) + ")";
}

std::string mismatch(const char* what, std::uint64_t theirs, std::uint64_t ours) {
  return std::string(what) + " " + std::to_string(theirs) + ", this reader knows " + std::to_string(ours) +
         " only";
}

Complaint bad_fraction(float fraction) {
  if (fraction >= 0.0F && fraction <= 1.0F) return std::nullopt;
  return "claims " + std::to_string(fraction) + " of a sweep's columns";
}

Complaint first_of(Complaint a, Complaint b) {
  return a ? std::move(a) : std::move(b);
}

bool is_grid_edge(std::int32_t size) {
  return size > 0 && size <= kMaxGridVoxels && size % kBrickEdge == 0;
}

Complaint bad_grid(const Int3& size) {
  if (size[0] == size[1] && is_grid_edge(size[0]) && is_grid_edge(size[2])) return std::nullopt;
  return "claims a grid of " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
         std::to_string(size[2]) + " voxels";
}

/// Of a message that says where it lies. Poses of odometry are their readers' to judge.
template <typename M>
Complaint bad_frame(const M& message) {
  if (auto complaint = bad_grid(message.grid.size)) return complaint;
  const auto fits = [](std::int32_t origin) {
    return origin >= -kMaxOriginVoxels && origin <= kMaxOriginVoxels && origin % kBrickEdge == 0;
  };
  const auto& origin = message.grid.origin;
  if (!std::all_of(std::begin(origin), std::end(origin), fits)) {
    return "claims to begin at voxel (" + std::to_string(origin[0]) + ", " + std::to_string(origin[1]) +
           ", " + std::to_string(origin[2]) + ")";
  }
  const auto near = [](double value) { return std::abs(value) <= kFarthest_m; };  // false for NaN
  const auto& position = message.T_odom_base.position_m;
  const auto& orientation = message.T_odom_base.orientation_xyzw;
  const bool pose = std::all_of(std::begin(position), std::end(position), near) &&
                    std::all_of(std::begin(orientation), std::end(orientation), near);
  return pose ? Complaint{} : Complaint{"has a pose that is not finite, or over 10,000 km away"};
}

/// A grid is laid around its vehicle, to a brick (R1).
Complaint bad_vehicle(const BrickMap& map) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double from_origin =
        map.T_odom_base.position_m[axis] / map.grid.resolution_m[axis] - map.grid.origin[axis];
    if (!(from_origin >= 0 && from_origin <= map.grid.size[axis] + kBrickEdge))
      return "has its vehicle outside of its grid";
  }
  return std::nullopt;
}

bool is_time(std::int64_t time_ns) {
  return time_ns >= -kMaxStamp_ns && time_ns <= kMaxStamp_ns;
}

Complaint bad_time(std::initializer_list<std::int64_t> times_ns) {
  for (const std::int64_t time_ns : times_ns)
    if (!is_time(time_ns)) return "has a time of " + std::to_string(time_ns) + " ns";
  return std::nullopt;
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
  if (auto complaint = bad_time({health.mono_ns})) return complaint;
  return first_of(too_many("counters", health.counter_count, Health::kMaxCounters),
                  too_many("stages", health.stage_count, Health::kMaxStages));
}

template <class Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [](double value) { return std::isfinite(value); });
}

Complaint check_course(const std::byte* message, std::size_t bytes) {
  if (auto complaint = wrong_size(bytes, sizeof(Course))) return complaint;
  const auto& course = as<Course>(message);
  if (auto complaint = too_many("places", course.count, Course::kMaxPlaces)) return complaint;
  for (std::uint32_t i = 0; i < course.count; ++i) {
    const auto& place = course.places[i];
    if (!(std::abs(place.x_m) <= kFarthest_m && std::abs(place.y_m) <= kFarthest_m))
      return "has a place that is not finite, or over 10,000 km away";
  }
  return std::nullopt;
}

Complaint check_plan(const std::byte* message, std::size_t bytes) {
  if (auto complaint = wrong_size(bytes, sizeof(Plan))) return complaint;
  const auto& plan = as<Plan>(message);
  if (auto complaint = bad_time({plan.mono_begun_ns, plan.mono_published_ns})) return complaint;
  return first_of(too_many("points of its path", plan.path_count, Plan::kMaxPoints),
                  too_many("points of its trajectory", plan.trajectory_count, Plan::kMaxPoints));
}

/// A vehicle moves by it.
Complaint check_command(const std::byte* message, std::size_t bytes) {
  if (auto complaint = wrong_size(bytes, sizeof(Command))) return complaint;
  const auto& command = as<Command>(message);
  if (!all_finite(std::initializer_list<double>{command.speed_mps, command.curvature_per_m}))
    return "has a speed or a curvature that is not finite";
  return bad_time({command.mono_deadline_ns});
}

Complaint check_layers(const std::byte* message, std::size_t bytes) {
  if (bytes < sizeof(Layers)) return wrong_size(bytes, sizeof(Layers));
  const auto& layers = as<Layers>(message);
  if (auto complaint = bad_frame(layers)) return complaint;
  if (auto complaint = bad_time({layers.mono_received_ns, layers.mono_mapped_ns, layers.mono_map_published_ns,
                                 layers.mono_fused_ns, layers.mono_published_ns, layers.suspended_ns}))
    return complaint;
  for (const LidarStatus& lidar : layers.lidars)
    if (auto complaint =
            first_of(bad_time({lidar.newest_stamp_ns}), bad_fraction(lidar.columns_seen_fraction)))
      return complaint;
  return first_of(too_many("lidars", layers.lidar_count, kMaxLidars),
                  wrong_size(bytes, layers_bytes(layers.grid.size[0])));
}

Complaint check_brick_map(const std::byte* message, std::size_t bytes) {
  if (bytes < sizeof(BrickMap)) return wrong_size(bytes, sizeof(BrickMap));
  const auto& map = as<BrickMap>(message);
  if (auto complaint = bad_frame(map)) return complaint;
  if (auto complaint = bad_vehicle(map)) return complaint;
  if (auto complaint = bad_time({map.mono_received_ns, map.suspended_ns, map.mono_mapped_ns,
                                 map.mono_published_ns, map.odometry_jump_ns}))
    return complaint;
  if (auto complaint = bad_fraction(map.columns_seen_fraction)) return complaint;
  const BrickMapShape& shape = map.shape;
  if (shape.brick_slots != map.grid.brick_slots()) {
    return "claims " + std::to_string(shape.brick_slots) + " brick slots, its grid has " +
           std::to_string(map.grid.brick_slots());
  }
  if (shape.column_count != map.grid.columns()) {
    return "claims " + std::to_string(shape.column_count) + " columns, its grid has " +
           std::to_string(map.grid.columns());
  }
  if (auto complaint = too_many("bricks", shape.brick_count, shape.brick_slots)) return complaint;
  return first_of(too_many("records", shape.record_count, shape.brick_count * std::uint64_t{kBrickCells}),
                  wrong_size(bytes, brick_map_bytes(shape)));
}

}  // namespace

const char* release() {
  return GVOM_VERSION;
}

std::optional<Refusal> check_message(const Topic& topic, const std::byte* message, std::size_t chunk_bytes) {
  using Reason = Refusal::Reason;
  if (chunk_bytes < sizeof(MessageHeader) || as<MessageHeader>(message).magic != kMagic) {
    return Refusal{Reason::foreign, "it is not from gvom"};
  }
  const auto& header = as<MessageHeader>(message);
  const auto type = static_cast<std::uint16_t>(topic.type);
  if (header.type != type) return Refusal{Reason::type, mismatch("message type", header.type, type)};
  if (header.version != topic.version) {
    return Refusal{Reason::version, other_version(topic, header.version)};
  }
  if (header.size < sizeof(MessageHeader) || header.size > chunk_bytes) {
    return Refusal{Reason::size, mismatch("size", header.size, chunk_bytes)};
  }
  if (!is_time(header.stamp_ns)) {
    return Refusal{Reason::size, "its stamp is " + std::to_string(header.stamp_ns) + " ns"};
  }
  if (const auto complaint = topic.check(message, header.size))
    return Refusal{Reason::size, "it " + *complaint};
  return std::nullopt;
}

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

template <>
Topic topic_of<Course>() {
  return {"course", kAll, Course::kType, Course::kVersion, check_course, kCourseQueue, kPlannerHistory};
}

template <>
Topic topic_of<Plan>() {
  return {"plan", kAll, Plan::kType, Plan::kVersion, check_plan, kPlanQueue, kPlannerHistory};
}

template <>
Topic topic_of<Command>() {
  return {"command", kAll, Command::kType, Command::kVersion, check_command, kCommandQueue, kPlannerHistory};
}

Topic layers_topic() {
  return {"layers", kAll, Layers::kType, Layers::kVersion, check_layers, kLayersQueue, kLayersHistory};
}

Topic voxel_map_topic() {
  return {"voxel_map", kAll, MessageType::voxel_map, BrickMap::kVersion, check_brick_map, kVoxelMapQueue};
}

bool is_lidar_name(std::string_view name) {
  return !name.empty() && name.size() < kNameLength && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
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
