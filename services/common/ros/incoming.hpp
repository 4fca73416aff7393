// The ROS 2 messages that gvom takes. Texts and data point into the message that was read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/ros/cdr_reader.hpp"

namespace gvom::ros {

inline constexpr std::size_t kVelodynePacketBytes = 1206;

struct HeaderIn {
  std::int64_t stamp_ns = 0;
  std::string_view frame_id;
};

/// Of nav_msgs/msg/Odometry the pose of `child_frame_id` in the header's frame; covariances and twist are not
/// read.
struct OdometryIn {
  HeaderIn header;
  std::string_view child_frame_id;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_xyzw{};
};

/// geometry_msgs/msg/TransformStamped.
struct TransformIn {
  HeaderIn header;
  std::string_view child_frame_id;
  std::array<double, 3> translation_m{};
  std::array<double, 4> rotation_xyzw{};
};

/// sensor_msgs/msg/PointField.
struct PointFieldIn {
  /// As in the message: INT8 is 1, FLOAT64 is 8.
  enum Datatype : std::uint8_t { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64 };

  std::string_view name;
  std::uint32_t offset_bytes = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};

/// sensor_msgs/msg/PointCloud2. `point_step` and `row_step` are bytes; nothing but the message's own form is
/// checked: whether `data` holds so many rows, and fields lie within a point, is the taker's to ask.
struct PointCloud2In {
  HeaderIn header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointFieldIn> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  Bytes data;
};

/// velodyne_msgs/msg/VelodynePacket: kVelodynePacketBytes bytes as the sensor sent them.
struct VelodynePacketIn {
  std::int64_t stamp_ns = 0;
  const std::uint8_t* data = nullptr;
};

/// All of these take a CDR message with its head, and fill `out` (cleared first, memory kept). Errors say at
/// which byte the message is not what it should be; `out` is then not to be used.
using Read = tl::expected<void, std::string>;

/// Nothing but the header that nearly every message begins with.
Read read_header(Bytes message, HeaderIn& out);
Read read_odometry(Bytes message, OdometryIn& out);
/// tf2_msgs/msg/TFMessage.
Read read_transforms(Bytes message, std::vector<TransformIn>& out);
Read read_point_cloud(Bytes message, PointCloud2In& out);
/// A PacketMsg of Ouster's drivers: the packet's bytes alone.
Read read_ouster_packet(Bytes message, Bytes& out);
/// velodyne_msgs/msg/VelodyneScan.
Read read_velodyne_scan(Bytes message, HeaderIn& header, std::vector<VelodynePacketIn>& out);

}  // namespace gvom::ros
