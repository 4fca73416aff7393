#include "tools/ctl/listener.hpp"

#include <poll.h>
#include <unistd.h>

#include <utility>

#include "ipc/fixed.hpp"
#include "ipc/layers.hpp"
#include "ipc/pool_use.hpp"
#include "ipc/waiter.hpp"
#include "services/common/exit_code.hpp"
#include "tools/ctl/frames.hpp"

namespace gvom::ctl {

namespace {

using services::ExitCode;

constexpr unsigned kLongestJoin_s = 6;
constexpr unsigned kLongestLeave_s = 3;
constexpr int kNames = 8;
constexpr std::chrono::milliseconds kLongestWait{100};

/// One message in the queue is enough: only the newest is shown, and the pools have little to spare.
ipc::Topic newest_of(ipc::Topic topic) {
  topic.queue = 1;
  return topic;
}

ipc::Expected<ipc::Runtime> join(int socket) {
  const auto log = [socket](const std::string& line) { send_frame(socket, FrameKind::note, line); };
  ipc::Expected<ipc::Runtime> runtime = tl::unexpected(ipc::Error{});
  for (int i = 1; i <= kNames; ++i) {
    runtime = ipc::Runtime::connect("gvomctl-" + std::to_string(i), std::chrono::milliseconds(0), log);
    const bool taken = !runtime && (runtime.error().kind == ipc::ErrorKind::in_use ||
                                    runtime.error().kind == ipc::ErrorKind::denied);
    if (!taken) break;
  }
  return runtime;
}

class Listener {
 public:
  static ipc::Expected<Listener> open(ipc::Runtime& runtime, int socket) {
    auto health = ipc::Subscriber<ipc::Health>::open(runtime);
    if (!health) return tl::unexpected(health.error());
    auto layers = ipc::InPort::open(runtime, newest_of(ipc::layers_topic()));
    if (!layers) return tl::unexpected(layers.error());
    auto odometry = ipc::InPort::open(runtime, newest_of(ipc::topic_of<ipc::Odometry>()));
    if (!odometry) return tl::unexpected(odometry.error());
    auto pools = ipc::PoolReports::open(runtime);
    if (!pools) return tl::unexpected(pools.error());
    auto waiter = ipc::Waiter::create(runtime);
    waiter.add(*layers);
    return Listener{
        socket,           std::move(*health), std::move(*layers), std::move(*odometry), std::move(*pools),
        std::move(waiter)};
  }

  /// False if nobody reads any more.
  bool pass_on() {
    waiter_.wait(kLongestWait);
    bool read = true;
    while (const auto health = health_.take()) read = send(FrameKind::health, **health);
    while (const auto chunk = layers_.take())
      read = send(FrameKind::layers, *reinterpret_cast<const ipc::Layers*>(chunk->data()));
    while (const auto chunk = odometry_.take())
      read = send(FrameKind::odometry, *reinterpret_cast<const ipc::MessageHeader*>(chunk->data()));
    if (const auto pools = pools_.take())
      read = send_frame(socket_, FrameKind::pools, pools->data(), pools->size() * sizeof(ipc::PoolUse));
    for (const auto& refusal : {health_.new_refusal(), layers_.new_refusal(), odometry_.new_refusal()})
      if (refusal) read = send_frame(socket_, FrameKind::refusal, *refusal);
    pollfd other_end{socket_, POLLIN, 0};
    return read && ::poll(&other_end, 1, 0) == 0;  // it never writes: readable is closed
  }

 private:
  Listener(int socket, ipc::Subscriber<ipc::Health> health, ipc::InPort layers, ipc::InPort odometry,
           ipc::PoolReports pools, ipc::Waiter waiter)
      : socket_(socket),
        health_(std::move(health)),
        layers_(std::move(layers)),
        odometry_(std::move(odometry)),
        pools_(std::move(pools)),
        waiter_(std::move(waiter)) {}

  template <typename M>
  bool send(FrameKind kind, const M& message) {
    return send_frame(socket_, kind, &message, sizeof message);
  }

  int socket_;
  ipc::Subscriber<ipc::Health> health_;
  ipc::InPort layers_;
  ipc::InPort odometry_;
  ipc::PoolReports pools_;
  ipc::Waiter waiter_;
};

int refused(int socket, const ipc::Error& error) {
  send_frame(socket, FrameKind::note, error.message);
  return to_int(ExitCode::unavailable);
}

}  // namespace

int listen_on_bus(int socket) {
  ::alarm(kLongestJoin_s);
  auto runtime = join(socket);
  if (!runtime) return refused(socket, runtime.error());
  auto listener = Listener::open(*runtime, socket);
  if (!listener) return refused(socket, listener.error());
  ::alarm(0);
  send_frame(socket, FrameKind::joined, nullptr, 0);
  while (listener->pass_on())
    if (!runtime->broker_alive()) ::_exit(to_int(ExitCode::try_again));  // destructors can hang
  ::alarm(kLongestLeave_s);
  return to_int(ExitCode::ok);
}

}  // namespace gvom::ctl
