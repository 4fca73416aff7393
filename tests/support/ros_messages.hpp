// The messages of a robot that drives: odometry, transforms, packets, clouds.
#pragma once

#include <array>

#include "tests/support/cdr_writer.hpp"

namespace gvom::test {

using Octets = std::vector<std::uint8_t>;

/// nav_msgs/msg/Odometry at (x, 0, 0) m, looking along x, with covariances and twist of zeros.
inline Octets odometry_message(std::int64_t stamp_ns, double x_m, const std::string& child = "base_link") {
  CdrWriter cdr;
  cdr.header(stamp_ns, "odom").text(child);
  for (const double value : {x_m, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) cdr.add(value);
  for (int i = 0; i < 36 + 6 + 36; ++i) cdr.add(0.0);
  return cdr.bytes();
}

struct Link {
  std::string parent;
  std::string child;
  std::int64_t stamp_ns = 0;
  std::array<double, 3> translation_m{};
  std::array<double, 4> rotation_xyzw{0, 0, 0, 1};
};

/// tf2_msgs/msg/TFMessage.
inline Octets tf_message(const std::vector<Link>& links) {
  CdrWriter cdr;
  cdr.add(static_cast<std::uint32_t>(links.size()));
  for (const Link& link : links) {
    cdr.header(link.stamp_ns, link.parent).text(link.child);
    for (const double value : link.translation_m) cdr.add(value);
    for (const double value : link.rotation_xyzw) cdr.add(value);
  }
  return cdr.bytes();
}

/// A PacketMsg of Ouster's drivers.
inline Octets ouster_message(const Octets& packet) {
  return CdrWriter().octets(packet).bytes();
}

/// velodyne_msgs/msg/VelodyneScan: packets of 1206 bytes, one every `step_ns`.
inline Octets velodyne_message(std::int64_t stamp_ns, const std::vector<Octets>& packets,
                               std::int64_t step_ns = 0) {
  CdrWriter cdr;
  cdr.header(stamp_ns, "velodyne").add(static_cast<std::uint32_t>(packets.size()));
  for (std::size_t i = 0; i < packets.size(); ++i)
    cdr.time(stamp_ns + static_cast<std::int64_t>(i) * step_ns).raw(packets[i]);
  return cdr.bytes();
}

struct CloudField {
  std::string name;
  std::uint32_t offset;
  std::uint8_t datatype;
};

struct CloudLayout {
  std::vector<CloudField> fields;
  std::uint32_t point_step = 0;
  std::uint32_t height = 1;
  std::uint32_t row_padding = 0;  ///< Bytes behind each row; below 0 (wrapped): that are missing.
  bool big_endian = false;        ///< Of the data.
};

/// sensor_msgs/msg/PointCloud2; `data` are whole rows with their padding.
inline Octets cloud_message(std::int64_t stamp_ns, const CloudLayout& layout, const Octets& data) {
  const auto row_step = static_cast<std::uint32_t>(data.size() / layout.height);
  CdrWriter cdr;
  cdr.header(stamp_ns, "lidar").add(layout.height).add((row_step - layout.row_padding) / layout.point_step);
  cdr.add(static_cast<std::uint32_t>(layout.fields.size()));
  for (const CloudField& field : layout.fields)
    cdr.text(field.name).add(field.offset).add(field.datatype).add(std::uint32_t{1});
  cdr.add(static_cast<std::uint8_t>(layout.big_endian)).add(layout.point_step).add(row_step);
  return cdr.octets(data).add(std::uint8_t{1}).bytes();
}

}  // namespace gvom::test
