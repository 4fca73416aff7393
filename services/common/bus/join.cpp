#include "services/common/bus/join.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "services/common/memory_lock.hpp"

namespace gvom::services {

using namespace std::chrono_literals;

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
    case ipc::ErrorKind::incompatible:
      break;
  }
  return ExitCode::internal;
}

tl::expected<ipc::Runtime, ExitCode> join_bus(const std::string& name, Lifecycle& lifecycle,
                                              std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!lifecycle.stopping() && !ipc::broker_answers() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(20ms);
  }
  if (lifecycle.stopping()) return tl::make_unexpected(ExitCode::ok);
  // A broker that hangs takes the request and never answers.
  lifecycle.on_stop([] { _exit(to_int(ExitCode::ok)); });
  auto runtime =
      ipc::Runtime::connect(name, 0ms, [](const std::string& line) { spdlog::warn("bus: {}", line); });
  lifecycle.on_stop({});
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

void BrokerWatch::check() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + 100ms;
  leave_if_gone();
}

void BrokerWatch::leave_if_gone() const {
  if (runtime_.broker_alive()) return;
  spdlog::critical("the broker is gone: leaving, to be started again");
  spdlog::shutdown();
  _exit(to_int(ExitCode::try_again));
}

}  // namespace gvom::services
