#include "tools/endurance/listener.hpp"

#include <unistd.h>

#include <cstdio>
#include <optional>

#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/pool_use.hpp"
#include "ipc/text.hpp"
#include "ipc/waiter.hpp"
#include "services/common/exit_code.hpp"
#include "tools/endurance/channel.hpp"
#include "tools/endurance/checksum.hpp"

namespace gvom::endurance {

namespace {

using services::ExitCode;

constexpr std::chrono::milliseconds kLongestWait{100};
constexpr unsigned kLongestJoin_s = 6;
constexpr std::uint64_t kLayersQueue = 6;  // of the room that the pools have for two planners

ipc::Topic longer(ipc::Topic topic) {
  topic.queue = kLayersQueue;
  return topic;
}

/// The maps in the window, as far as the sensors' clock tells them: the same in each round.
std::uint64_t key_of(const ipc::Layers& layers) {
  Checksum key;
  key.add(layers.header.stamp_ns);
  key.add(layers.maps_in_window);
  for (std::uint32_t i = 0; i < layers.lidar_count; ++i) {
    const ipc::LidarStatus& lidar = layers.lidars[i];
    key.add(lidar.maps_in_window);
    key.add(lidar.maps_in_window > 0 ? lidar.newest_stamp_ns : 0);
  }
  return key.value();
}

std::uint64_t checksum_of(const ipc::LayersSample& layers) {
  Checksum sum;
  const ipc::Layers& header = layers.header();
  sum.add(header.grid.origin);
  sum.add(header.grid.size);
  sum.add(header.T_odom_base.position_m);
  sum.add(header.T_odom_base.orientation_xyzw);
  for (int i = 0; i < kLayers; ++i) {
    const auto floats = layers.layer_f(static_cast<LayerId>(i));
    sum.add(floats.data(), floats.size() * sizeof(float));
    const auto bytes = layers.layer_u8(static_cast<LayerId>(i));
    sum.add(bytes.data(), bytes.size());
  }
  return sum.value();
}

LayersNote note_of(const ipc::LayersSample& sample, std::uint64_t lost) {
  const ipc::Layers& layers = sample.header();
  LayersNote note{};
  note.epoch = layers.header.epoch;
  note.sequence = layers.header.sequence;
  note.key = key_of(layers);
  note.checksum = checksum_of(sample);
  note.received_mono_ns = layers.mono_received_ns;
  note.published_mono_ns = layers.mono_published_ns;
  note.heard_mono_ns = ipc::monotonic_ns();
  note.lost = lost;
  note.lidars = layers.lidar_count;
  for (std::uint32_t i = 0; i < layers.lidar_count; ++i) {
    note.missing += layers.lidars[i].missing;
    note.maps[i] = layers.lidars[i].maps_received + layers.lidars[i].maps_lost;
  }
  return note;
}

class Listener {
 public:
  static ipc::Expected<Listener> open(ipc::Runtime& runtime, Board& board, int socket) {
    auto health = ipc::Subscriber<ipc::Health>::open(runtime);
    if (!health) return tl::unexpected(health.error());
    auto layers = ipc::InPort::open(runtime, longer(ipc::layers_topic()));
    if (!layers) return tl::unexpected(layers.error());
    auto odometry = ipc::Subscriber<ipc::Odometry>::open(runtime);
    if (!odometry) return tl::unexpected(odometry.error());
    auto voxels = ipc::BrickMapSubscriber::voxel_map(runtime);
    if (!voxels) return tl::unexpected(voxels.error());
    auto pools = ipc::PoolReports::open(runtime);
    if (!pools) return tl::unexpected(pools.error());
    auto waiter = ipc::Waiter::create(runtime);
    waiter.add(*layers);
    waiter.add(*odometry);
    return Listener{board,
                    socket,
                    std::move(*health),
                    std::move(*layers),
                    std::move(*odometry),
                    std::move(*voxels),
                    std::move(*pools),
                    std::move(waiter)};
  }

  /// False if nobody reads any more.
  bool pass_on() {
    waiter_.wait(kLongestWait);
    bool read = true;
    while (const auto odometry = odometry_.take()) take((*odometry)->header);
    while (auto chunk = layers_.take())
      read = send_note(socket_, NoteKind::layers,
                       note_of(ipc::LayersSample(std::move(*chunk)), layers_.counters().lost)) &&
             read;
    while (const auto health = health_.take()) read = send_note(socket_, NoteKind::health, **health) && read;
    while (const auto map = voxels_.take()) ++voxel_maps_;
    if (const auto pools = pools_.take())
      read = send_note(socket_, NoteKind::pools, pools->data(), pools->size() * sizeof(ipc::PoolUse)) && read;
    if (ipc::monotonic_ns() < next_alive_ns_) return read;
    next_alive_ns_ = ipc::monotonic_ns() + 200'000'000;
    return send_note(socket_, NoteKind::alive, AliveNote{ipc::monotonic_ns(), voxel_maps_}) && read;
  }

 private:
  Listener(Board& board, int socket, ipc::Subscriber<ipc::Health> health, ipc::InPort layers,
           ipc::Subscriber<ipc::Odometry> odometry, ipc::BrickMapSubscriber voxels, ipc::PoolReports pools,
           ipc::Waiter waiter)
      : board_(board),
        socket_(socket),
        health_(std::move(health)),
        layers_(std::move(layers)),
        odometry_(std::move(odometry)),
        voxels_(std::move(voxels)),
        pools_(std::move(pools)),
        waiter_(std::move(waiter)) {}

  /// An epoch is the time at which its round began; but the first one of a process waits for its readers.
  void take(const ipc::MessageHeader& odometry) {
    if (odometry.epoch == board_.epoch) return;
    const bool first = odometry.sequence == 1;
    board_.begin_ns = first ? ipc::monotonic_ns() : static_cast<std::int64_t>(odometry.epoch);
    board_.epoch = odometry.epoch;
  }

  Board& board_;
  int socket_;
  ipc::Subscriber<ipc::Health> health_;
  ipc::InPort layers_;
  ipc::Subscriber<ipc::Odometry> odometry_;
  ipc::BrickMapSubscriber voxels_;
  ipc::PoolReports pools_;
  ipc::Waiter waiter_;
  std::uint64_t voxel_maps_ = 0;
  std::int64_t next_alive_ns_ = 0;
};

}  // namespace

int listen_on_bus(Board& board, int socket) {
  ::alarm(kLongestJoin_s);
  auto runtime = ipc::Runtime::connect("gvom-soak", std::chrono::milliseconds(0));
  if (!runtime) return to_int(ExitCode::try_again);
  auto listener = Listener::open(*runtime, board, socket);
  if (!listener) {
    std::fprintf(stderr, "gvom-soak: %s\n", listener.error().message.c_str());
    return to_int(ExitCode::unavailable);
  }
  ::alarm(0);
  while (listener->pass_on())
    if (!runtime->broker_alive()) return to_int(ExitCode::try_again);
  return to_int(ExitCode::ok);
}

}  // namespace gvom::endurance
