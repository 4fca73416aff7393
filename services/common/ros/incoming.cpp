#include "services/common/ros/incoming.hpp"

namespace gvom::ros {
namespace {

constexpr std::size_t kMostFrameIdBytes = 4096;
constexpr std::size_t kMostFields = 256;
constexpr std::size_t kLeastFieldBytes = 13;      // an empty name, offset, datatype, count
constexpr std::size_t kLeastTransformBytes = 64;  // seven doubles and a stamp
constexpr std::uint32_t kNanosecondsInSecond = 1'000'000'000;

std::int64_t read_time_ns(CdrReader& cdr) {
  const auto seconds = cdr.read<std::int32_t>();
  const auto nanoseconds = cdr.read<std::uint32_t>();
  if (nanoseconds >= kNanosecondsInSecond)
    cdr.fail("a time with " + std::to_string(nanoseconds) + " nanoseconds past its second");
  return std::int64_t{seconds} * kNanosecondsInSecond + nanoseconds;
}

HeaderIn read_header(CdrReader& cdr) {
  HeaderIn header;
  header.stamp_ns = read_time_ns(cdr);
  header.frame_id = cdr.string(kMostFrameIdBytes);
  return header;
}

template <std::size_t n>
void read_doubles(CdrReader& cdr, std::array<double, n>& out) {
  for (double& value : out) value = cdr.read<double>();
}

PointFieldIn read_field(CdrReader& cdr) {
  PointFieldIn field;
  field.name = cdr.string(kMostFrameIdBytes);
  field.offset_bytes = cdr.read<std::uint32_t>();
  field.datatype = cdr.read<std::uint8_t>();
  field.count = cdr.read<std::uint32_t>();
  return field;
}

Read result_of(const CdrReader& cdr) {
  if (cdr.ok()) return {};
  return tl::unexpected(cdr.error());
}

}  // namespace

Read read_header(Bytes message, HeaderIn& out) {
  CdrReader cdr(message);
  out = read_header(cdr);
  return result_of(cdr);
}

Read read_odometry(Bytes message, OdometryIn& out) {
  CdrReader cdr(message);
  out.header = read_header(cdr);
  out.child_frame_id = cdr.string(kMostFrameIdBytes);
  read_doubles(cdr, out.position_m);
  read_doubles(cdr, out.orientation_xyzw);
  return result_of(cdr);
}

Read read_transforms(Bytes message, std::vector<TransformIn>& out) {
  CdrReader cdr(message);
  out.clear();
  const std::uint32_t count = cdr.count(kLeastTransformBytes);
  out.reserve(count);
  for (std::uint32_t i = 0; i < count && cdr.ok(); ++i) {
    TransformIn& transform = out.emplace_back();
    transform.header = read_header(cdr);
    transform.child_frame_id = cdr.string(kMostFrameIdBytes);
    read_doubles(cdr, transform.translation_m);
    read_doubles(cdr, transform.rotation_xyzw);
  }
  return result_of(cdr);
}

Read read_point_cloud(Bytes message, PointCloud2In& out) {
  CdrReader cdr(message);
  out.header = read_header(cdr);
  out.height = cdr.read<std::uint32_t>();
  out.width = cdr.read<std::uint32_t>();
  out.fields.clear();
  const std::uint32_t count = cdr.count(kLeastFieldBytes);
  if (count > kMostFields) cdr.fail(std::to_string(count) + " fields a point");
  for (std::uint32_t i = 0; i < count && cdr.ok(); ++i) out.fields.push_back(read_field(cdr));
  out.is_bigendian = cdr.read<std::uint8_t>() != 0;
  out.point_step = cdr.read<std::uint32_t>();
  out.row_step = cdr.read<std::uint32_t>();
  out.data = cdr.octets();
  return result_of(cdr);
}

Read read_ouster_packet(Bytes message, Bytes& out) {
  CdrReader cdr(message);
  out = cdr.octets();
  return result_of(cdr);
}

Read read_velodyne_scan(Bytes message, HeaderIn& header, std::vector<VelodynePacketIn>& out) {
  CdrReader cdr(message);
  out.clear();
  header = read_header(cdr);
  const std::uint32_t count = cdr.count(8 + kVelodynePacketBytes);
  out.reserve(count);
  for (std::uint32_t i = 0; i < count && cdr.ok(); ++i) {
    const std::int64_t stamp_ns = read_time_ns(cdr);
    out.push_back({stamp_ns, cdr.array(kVelodynePacketBytes).data});
  }
  return result_of(cdr);
}

}  // namespace gvom::ros
