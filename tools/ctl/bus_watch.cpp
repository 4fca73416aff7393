#include "tools/ctl/bus_watch.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "ipc/broker_probe.hpp"
#include "ipc/runtime.hpp"
#include "services/common/exit_code.hpp"
#include "tools/ctl/frames.hpp"
#include "tools/ctl/listener.hpp"

namespace gvom::ctl {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kJoinPatience_ns = 3 * kSecond_ns;     // it takes some milliseconds
constexpr std::int64_t kSilencePatience_ns = 3 * kSecond_ns;  // the broker itself reports once a second
constexpr std::int64_t kRestartPause_ns = kSecond_ns / 2;
constexpr std::chrono::milliseconds kProbePatience{1000};
constexpr std::chrono::milliseconds kLeavePatience{1000};

template <typename M>
M message_of(const Frame& frame) {
  M message{};
  std::memcpy(&message, frame.payload.data(), std::min(sizeof message, frame.payload.size()));
  return message;
}

std::vector<ipc::PoolUse> pools_of(const Frame& frame) {
  std::vector<ipc::PoolUse> pools(frame.payload.size() / sizeof(ipc::PoolUse));
  std::memcpy(pools.data(), frame.payload.data(), pools.size() * sizeof(ipc::PoolUse));
  return pools;
}

std::string text_of(const Frame& frame) {
  return {reinterpret_cast<const char*>(frame.payload.data()), frame.payload.size()};
}

std::string why_absent(const std::optional<std::uint32_t>& pid) {
  if (!pid) return "no broker answers: is gvom-roudi running?";
  const auto owner = ipc::broker_owner();
  if (owner && owner->user != ::geteuid())
    return "it runs, but as user " + std::to_string(owner->user) +
           ", who alone reaches it: run this as that user, or as root";
  return "its process is there, but does not answer (yet)";
}

/// Waits for its end, and kills it if that does not come. Its exit code, -1 if it was killed.
int end_of(pid_t child, std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() >= deadline) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

BusWatch::~BusWatch() {
  end_listener();
}

void BusWatch::step(std::chrono::milliseconds timeout) {
  const std::int64_t now_ns = ipc::monotonic_ns();
  look_at_broker(now_ns);
  if (listener_ < 0 && state_ == BrokerState::up && now_ns >= next_start_ns_) start(now_ns);
  if (listener_ < 0) {
    std::this_thread::sleep_for(timeout);
    return;
  }
  receive(timeout);
  judge_listener(ipc::monotonic_ns());
}

Broker BusWatch::broker() const {
  Broker broker{state_, joined_, std::nullopt, joined_ || refused_ ? note_ : ""};
  if (const auto pid = ipc::broker_pid()) broker.pid = static_cast<std::uint32_t>(*pid);
  if (state_ == BrokerState::absent) broker.note = why_absent(broker.pid);
  return broker;
}

void BusWatch::look_at_broker(std::int64_t now_ns) {
  if (now_ns < next_look_ns_) return;
  next_look_ns_ = now_ns + kSecond_ns;
  if (ipc::broker_works(kProbePatience))
    state_ = BrokerState::up;
  else
    state_ = ipc::broker_answers() ? BrokerState::hung : BrokerState::absent;
}

void BusWatch::start(std::int64_t now_ns) {
  int sockets[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0) return;
  std::fflush(nullptr);  // or the child prints it again
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(sockets[1], STDERR_FILENO + 1);
    ::close_range(STDERR_FILENO + 2, ~0U, 0);  // nothing of ours stays open in it
    std::exit(listen_on_bus(STDERR_FILENO + 1));
  }
  ::close(sockets[1]);
  if (child < 0) {
    ::close(sockets[0]);
    return;
  }
  listener_ = child;
  socket_ = sockets[0];
  joined_ = false;
  started_ns_ = heard_ns_ = now_ns;
  note_.clear();
  refused_ = false;
}

void BusWatch::receive(std::chrono::milliseconds timeout) {
  pollfd readable{socket_, POLLIN, 0};
  ::poll(&readable, 1, static_cast<int>(timeout.count()));
  Frame frame;
  Received received = Received::nothing;
  while ((received = receive_frame(socket_, frame)) == Received::frame) {
    heard_ns_ = frame.mono_ns;
    switch (frame.kind) {
      case FrameKind::joined:
        joined_ = true;
        break;
      case FrameKind::health:
        observed_.add(message_of<ipc::Health>(frame));
        break;
      case FrameKind::layers:
        observed_.add(message_of<ipc::Layers>(frame));
        break;
      case FrameKind::odometry:
        observed_.add(message_of<ipc::MessageHeader>(frame), frame.mono_ns);
        break;
      case FrameKind::pools:
        observed_.add(pools_of(frame));
        break;
      case FrameKind::note:
        note_ = text_of(frame);
        break;
      case FrameKind::refusal:
        observed_.add_refusal(text_of(frame));
        break;
    }
  }
  if (received != Received::end) return;
  end_listener();
  next_look_ns_ = 0;  // the broker is gone, or it did not let us in
}

/// A broker can hang after its last look: then who joins hears nothing.
void BusWatch::judge_listener(std::int64_t now_ns) {
  if (listener_ < 0) return;
  const bool barred = !joined_ && now_ns - started_ns_ > kJoinPatience_ns;
  const bool deaf = joined_ && now_ns - heard_ns_ > kSilencePatience_ns;
  if (!barred && !deaf) return;
  ::kill(listener_, SIGKILL);
  end_listener();
  state_ = BrokerState::hung;
  next_look_ns_ = now_ns + kSecond_ns;
}

void BusWatch::end_listener() {
  if (listener_ < 0) return;
  ::close(socket_);  // it sees that and leaves
  // Another end is nobody's verdict: two that chose one name at the same moment, for one.
  refused_ = end_of(listener_, kLeavePatience) == to_int(services::ExitCode::unavailable);
  listener_ = -1;
  joined_ = false;
  next_start_ns_ = ipc::monotonic_ns() + kRestartPause_ns;
}

}  // namespace gvom::ctl
