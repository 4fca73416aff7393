#include "services/common/bus/join.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>

#include "ipc/system.hpp"
#include "services/common/memory_lock.hpp"

namespace gvom::services {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

namespace {

constexpr auto kPeriod = 100ms;
constexpr auto kLook = 20ms;     // it costs microseconds
constexpr auto kTellAgain = 1s;  // systemd, that this still waits
constexpr auto kJoinPatience = 10s;

double seconds_since(steady_clock::time_point then) {
  return std::chrono::duration<double>(steady_clock::now() - then).count();
}

/// Until it answers, a stop is asked for or the patience is at its end.
void wait_for_broker(Lifecycle& lifecycle, std::chrono::milliseconds patience) {
  const auto begin = steady_clock::now();
  auto next_word = begin;
  bool logged = false;
  while (!lifecycle.stopping() && !ipc::broker_answers() && steady_clock::now() - begin < patience) {
    if (steady_clock::now() >= next_word) {
      logged = next_word != begin;
      if (next_word == begin + kTellAgain) spdlog::warn("waiting for the broker: is gvom-roudi running?");
      notify_waiting("waiting for the broker, gvom-roudi");
      next_word += kTellAgain;
    }
    lifecycle.sleep_until(steady_clock::now() + kLook);
  }
  if (logged && ipc::broker_answers())
    spdlog::info("the broker is there after {:.1f} s", seconds_since(begin));
}

/// For the time of joining: a broker that hangs, or dies meanwhile, takes the request and never answers.
class JoinGuard {
 public:
  explicit JoinGuard(Lifecycle& lifecycle)
      : lifecycle_(lifecycle), broker_(ipc::management_inode()), thread_([this] { check(); }) {
    lifecycle_.on_stop([] { ::_exit(to_int(ExitCode::ok)); });
  }
  ~JoinGuard() { lifecycle_.on_stop({}); }
  JoinGuard(const JoinGuard&) = delete;
  JoinGuard& operator=(const JoinGuard&) = delete;

 private:
  void check() const {
    const bool gone = ipc::management_inode() != broker_ || !ipc::broker_answers();
    if (!gone && steady_clock::now() - begin_ < kJoinPatience) return;
    if (lifecycle_.stop_asked()) ::_exit(to_int(ExitCode::ok));
    spdlog::critical(gone ? "the broker went while this process joined it: leaving, to be started again"
                          : "the broker does not answer: leaving, to be started again");
    ::_exit(to_int(ExitCode::try_again));
  }

  Lifecycle& lifecycle_;
  const std::uint64_t broker_;
  const steady_clock::time_point begin_ = steady_clock::now();
  TenTimesASecond thread_;
};

}  // namespace

ExitCode exit_code_of(const ipc::Error& error) {
  switch (error.kind) {
    case ipc::ErrorKind::unavailable:
    case ipc::ErrorKind::denied:
    case ipc::ErrorKind::no_space:
      return ExitCode::unavailable;
    case ipc::ErrorKind::in_use:
    case ipc::ErrorKind::exhausted:
    case ipc::ErrorKind::timeout:
    case ipc::ErrorKind::stale:
      return ExitCode::try_again;
    case ipc::ErrorKind::too_large:
      return ExitCode::configuration;
    case ipc::ErrorKind::bad_name:
      break;
  }
  return ExitCode::internal;
}

std::chrono::milliseconds broker_patience() {
  return std::getenv("NOTIFY_SOCKET") != nullptr ? std::chrono::hours(24 * 365 * 100) : 10s;
}

tl::expected<ipc::Runtime, ExitCode> join_bus(const std::string& name, Lifecycle& lifecycle,
                                              std::chrono::milliseconds patience) {
  wait_for_broker(lifecycle, patience);
  if (lifecycle.stopping()) return tl::make_unexpected(ExitCode::ok);
  auto runtime = [&] {
    const JoinGuard guard(lifecycle);
    return ipc::Runtime::connect(
        name, 0ms, [](const std::string& line) { spdlog::warn("bus: {}", line); },
        [&lifecycle] { return lifecycle.stop_asked(); });
  }();
  if (runtime) return std::move(*runtime);
  spdlog::error("{}", runtime.error().message);
  return tl::make_unexpected(exit_code_of(runtime.error()));
}

HostMemory ready_payloads(const ipc::Runtime& runtime) {
  if (const auto faulted = runtime.prefault(); !faulted) spdlog::warn("{}", faulted.error().message);
  if (const auto locked = lock_memory(); !locked) spdlog::warn("{}", locked.error());
  const auto payloads = runtime.payload_segment();
  return payloads ? HostMemory{payloads->base, payloads->bytes} : HostMemory{};
}

TenTimesASecond::TenTimesASecond(std::function<void()> call)
    : thread_([this, call = std::move(call)] {
        std::unique_lock lock(mutex_);
        while (!changed_.wait_for(lock, kPeriod, [this] { return done_; })) call();
      }) {}

TenTimesASecond::~TenTimesASecond() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

BrokerWatch::BrokerWatch(const ipc::Runtime& runtime, const Lifecycle& lifecycle)
    : runtime_(runtime), lifecycle_(lifecycle), thread_([this] { leave_if_gone(); }) {}

void BrokerWatch::leave_if_gone() const {
  if (runtime_.broker_alive()) return;
  if (lifecycle_.stop_asked()) {
    spdlog::warn("the broker is gone before this process has left");
    ::_exit(to_int(ExitCode::ok));
  }
  spdlog::critical("the broker is gone: leaving, to be started again");
  ::_exit(to_int(ExitCode::try_again));
}

}  // namespace gvom::services
