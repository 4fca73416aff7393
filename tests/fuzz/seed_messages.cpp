#include "ipc/layers.hpp"
#include "ipc/text.hpp"
#include "ipc/topic.hpp"
#include "tests/fuzz/seeds.hpp"

namespace gvom::fuzz {

namespace {

constexpr int kSize = 8;  // of the grids, voxels
using test::ByteVector;

/// Room for the message, its header right.
ByteVector blank(const ipc::Topic& topic, std::size_t bytes) {
  ipc::MessageHeader header{};
  header.magic = ipc::kMagic;
  header.type = static_cast<std::uint16_t>(topic.type);
  header.version = topic.version;
  header.size = bytes;
  header.sequence = 1;
  header.stamp_ns = 1'000'000'000;
  header.epoch = 1;
  ByteVector message(bytes);
  std::memcpy(message.data(), &header, sizeof header);
  return message;
}

template <typename M>
M& as(ByteVector& message) {
  return *reinterpret_cast<M*>(message.data());
}

/// `number` is the topic's in fuzz_messages.
void add(Seeds& seeds, std::uint8_t number, const ByteVector& message) {
  ByteVector input{number};
  test::append(input, message);
  seeds.add("messages", input);
}

template <class Message>
void set_frame(Message& message) {
  message.grid.size.fill(kSize);
  message.grid.resolution_m.fill(0.4);
  message.T_odom_base.orientation_xyzw[3] = 1;
}

/// One brick: a voxel that was hit, one that was passed.
ByteVector map_message(const ipc::Topic& topic) {
  const auto layout = ipc::brick_map_layout({1, 1, 1, kBrickColumns});
  ByteVector message = blank(topic, layout.bytes);
  auto& map = as<ipc::BrickMap>(message);
  set_frame(map);
  for (std::int32_t& origin : map.grid.origin) origin = -kSize / 2 / 8 * 8 - 8;
  map.shape = {1, 1, 1, kBrickColumns};
  auto* lookup = reinterpret_cast<std::int32_t*>(message.data() + layout.lookup);
  std::fill_n(lookup, kBrickCells, -1);
  lookup[3] = 0;
  lookup[4] = -2;
  *reinterpret_cast<std::uint64_t*>(message.data() + layout.columns) = 1;
  auto* lowest_ray_m = reinterpret_cast<float*>(message.data() + layout.lowest_ray);
  std::fill_n(lowest_ray_m, kBrickColumns, kNoRay_m);
  lowest_ray_m[1] = 0.25F;
  *reinterpret_cast<VoxelRecord*>(message.data() + layout.records) = {2, 1, 0.5F};
  return message;
}

ByteVector layers_message() {
  ByteVector message = blank(ipc::layers_topic(), ipc::layers_bytes(kSize));
  auto& layers = as<ipc::Layers>(message);
  set_frame(layers);
  layers.lidar_count = 1;
  layers.lidars[0].missing = 1;
  ipc::set_text(layers.lidars[0].name, "front");
  return message;
}

}  // namespace

void add_messages(Seeds& seeds) {
  ByteVector odometry = blank(ipc::topic_of<ipc::Odometry>(), sizeof(ipc::Odometry));
  as<ipc::Odometry>(odometry).T_odom_base.orientation_xyzw[3] = 1;
  add(seeds, 0, odometry);

  ByteVector progress = blank(ipc::topic_of<ipc::Progress>(), sizeof(ipc::Progress));
  ipc::set_text(as<ipc::Progress>(progress).reader, "fusion");
  as<ipc::Progress>(progress).lidar_count = 1;
  ipc::set_text(as<ipc::Progress>(progress).taken[0].lidar, "front");
  add(seeds, 1, progress);

  ByteVector health = blank(ipc::topic_of<ipc::Health>(), sizeof(ipc::Health));
  ipc::set_text(as<ipc::Health>(health).process, "gvom-fusion");
  as<ipc::Health>(health).counter_count = as<ipc::Health>(health).stage_count = 1;
  add(seeds, 2, health);

  add(seeds, 3, layers_message());
  add(seeds, 4, map_message(*ipc::buffer_map_topic("front")));
  add(seeds, 5, map_message(ipc::voxel_map_topic()));
}

}  // namespace gvom::fuzz
