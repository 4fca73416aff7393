// The topics: names, message types, queues. Live data: a full queue loses its oldest, and the gap is counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/error.hpp"
#include "ipc/messages.hpp"

namespace gvom::ipc {

/// How deep the queue of each subscriber is, and what a publisher keeps for those who join late.
inline constexpr std::uint32_t kOdometryQueue = 256;
inline constexpr std::uint32_t kBufferMapQueue = 16;
inline constexpr std::uint32_t kVoxelMapQueue = 1;
inline constexpr std::uint32_t kLayersQueue = 2;
inline constexpr std::uint32_t kLayersHistory = 1;
inline constexpr std::uint32_t kProgressQueue = 64;
inline constexpr std::uint32_t kHealthQueue = 32;
inline constexpr std::uint32_t kCourseQueue = 1;
inline constexpr std::uint32_t kPlanQueue = 2;
inline constexpr std::uint32_t kCommandQueue = 1;
inline constexpr std::uint32_t kPlannerHistory = 1;  // of all three

/// What is wrong with a message of `bytes` whose header is right, in words; nothing if it is as its type
/// says.
using MessageCheck = std::optional<std::string> (*)(const std::byte* message, std::size_t bytes);

struct Topic {
  std::string name;      ///< "odometry", "buffer_map", ...
  std::string instance;  ///< The lidar of a buffer map; "all" for the others.
  MessageType type;
  std::uint16_t version;
  MessageCheck check;
  std::uint32_t queue;
  std::uint32_t history = 0;
};

/// Why a message is not read.
struct Refusal {
  enum class Reason { foreign, type, version, size };
  Reason reason;
  std::string why;  ///< In words; of another version, a sentence that names the release it is of.
};

/// Of this gvom, e.g. "0.3.0".
const char* release();

/// Nothing if the message at `message`, in a chunk of `chunk_bytes`, is one of the topic's and fits its
/// chunk: whatever its counts and sizes say can then be read.
std::optional<Refusal> check_message(const Topic& topic, const std::byte* message, std::size_t chunk_bytes);

template <typename M>
Topic topic_of();
template <>
Topic topic_of<Odometry>();
template <>
Topic topic_of<Progress>();
template <>
Topic topic_of<Health>();
template <>
Topic topic_of<Course>();
template <>
Topic topic_of<Plan>();
template <>
Topic topic_of<Command>();
Topic layers_topic();
Topic voxel_map_topic();

/// 1 .. 31 of [a-z0-9_].
bool is_lidar_name(std::string_view name);

/// bad_name if `lidar` is not 1 .. 31 of [a-z0-9_].
Expected<Topic> buffer_map_topic(const std::string& lidar);

}  // namespace gvom::ipc
