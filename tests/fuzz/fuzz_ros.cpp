// ROS 2 messages from strangers, and what becomes of them. First byte: the type, 0 .. 6.
#include "services/common/bag/bag_folder.hpp"
#include "services/common/odometry_tf.hpp"
#include "services/common/ros/incoming.hpp"
#include "services/ingest/cloud_sweep.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

constexpr std::size_t kMaxReturns = 100;

void try_cloud(ros::Bytes message, const ingest::CloudOptions& options) {
  ros::PointCloud2In cloud;
  if (!ros::read_point_cloud(message, cloud)) return;
  ingest::CloudSweep sweeps(options, "/points", "bag");
  ingest::SourceState state;
  Sweep sweep;
  for (int i = 0; i < 2; ++i)
    if (sweeps.make(cloud, state, sweep)) check_sweep(sweep, kMaxReturns);
}

void try_transforms(ros::Bytes message) {
  std::vector<ros::TransformIn> transforms;
  if (!ros::read_transforms(message, transforms)) return;
  services::TfLinks links;
  for (const ros::TransformIn& transform : transforms) links.see(transform);
  const auto chain = links.chain("odom", "base_link");
  for (const ros::TransformIn& transform : transforms) {
    if (!chain || !chain->is_moving(transform)) continue;
    const auto pose = chain->pose_by(transform);
    require(!pose || std::abs(pose->T_odom_base.rotation.norm() - 1) < 1e-3, "a pose has a rotation");
  }
}

void try_scan(ros::Bytes message) {
  ros::HeaderIn header;
  std::vector<ros::VelodynePacketIn> packets;
  if (!ros::read_velodyne_scan(message, header, packets)) return;
  for (const ros::VelodynePacketIn& packet : packets) {
    const std::uint8_t* const end = packet.data + ros::kVelodynePacketBytes;
    require(packet.data >= message.data && end <= message.data + message.size, "a packet is in its message");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const std::uint8_t type = input.byte();
  const ingest::Bytes rest = input.rest();
  const ros::Bytes message{rest.data, rest.size};
  ros::OdometryIn odometry;
  ros::Bytes packet;
  switch (type) {
    case 0:
      static_cast<void>(ros::read_odometry(message, odometry));
      break;
    case 1:
      try_transforms(message);
      break;
    case 2:
      try_cloud(message, {kMaxReturns, {}});
      break;
    case 3:
      try_cloud(message, {kMaxReturns, ingest::TimeUnit::none});
      break;
    case 4:
      if (ros::read_ouster_packet(message, packet))
        require(packet.size <= message.size, "a packet is in its message");
      break;
    case 5:
      try_scan(message);
      break;
    case 6:
      bag::listed_files(text_of(rest));
      break;
    default:
      break;
  }
  return 0;
}
