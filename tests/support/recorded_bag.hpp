// A simulated recording as a ROS 2 bag.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/common/odometry_file.hpp"
#include "services/ingest/pcap_reader.hpp"
#include "tests/support/db3_builder.hpp"
#include "tests/support/mcap_builder.hpp"
#include "tests/support/ros_messages.hpp"

namespace gvom::test {

inline Octets pose_message(const StampedPose& pose) {
  CdrWriter cdr;
  cdr.header(pose.stamp_ns, "odom").text("base_link");
  const Eigen::Vector3d& p = pose.T_odom_base.translation_m;
  const Eigen::Quaterniond& q = pose.T_odom_base.rotation;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) cdr.add(value);
  return cdr.bytes();
}

/// The topic of a lidar's packets: "/front/lidar_packets".
inline std::string packets_topic(const std::string& lidar) {
  return "/" + lidar + "/lidar_packets";
}

/// FOLDER/LIDAR.pcap of each and FOLDER/odometry.tum as a split bag: packets in SQLite, odometry (/odom) in
/// MCAP, by a recorder whose clock is a minute late. Throws.
inline void record_bag(const std::string& folder, const std::vector<std::string>& lidars,
                       const std::string& bag) {
  constexpr std::int64_t kLate_ns = 60'000'000'000;
  std::filesystem::create_directory(bag);
  Db3Builder packets(bag + "/bag_0.db3");
  for (const std::string& lidar : lidars) {
    ingest::SourceState state;
    auto pcap = ingest::PcapReader::open(folder + "/" + lidar + ".pcap", {}, state);
    if (!pcap) throw std::runtime_error(pcap.error());
    const int topic = packets.topic(packets_topic(lidar), "ouster_sensor_msgs/msg/PacketMsg");
    ingest::Packet packet;
    std::int64_t log_ns = kLate_ns;
    while ((*pcap)->next(packet, std::chrono::milliseconds(0)).value() == ingest::PacketEvent::packet)
      packets.add(topic, ++log_ns, ouster_message(Octets(packet.data, packet.data + packet.size)));
  }
  McapBuilder odometry({"zstd", 10});
  const auto channel = odometry.topic("/odom", "nav_msgs/msg/Odometry");
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source("tum:" + folder + "/odometry.tum", warnings);
  if (!poses) throw std::runtime_error(poses.error());
  for (const StampedPose& pose : *poses) odometry.add(channel, pose.stamp_ns + kLate_ns, pose_message(pose));
  odometry.write(bag + "/bag_1.mcap");
}

}  // namespace gvom::test
