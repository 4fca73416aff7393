// The shared-memory broker (iceoryx's RouDi) with our pools. Library gvom_broker, so that nobody else links
// it.
#pragma once

#include <functional>
#include <memory>

#include "ipc/error.hpp"
#include "ipc/pools.hpp"
#include "ipc/runtime.hpp"

namespace gvom::ipc {

struct BrokerOptions {
  PoolPlan plan;
  std::function<void()> heartbeat;  ///< Called at 10 Hz from the broker's own loop: feed the watchdog here.
  LogSink log;                      ///< As Runtime::connect's.
};

/// Bytes of shared memory that the broker needs for `plan` in all: payload and bookkeeping.
std::uint64_t shared_memory_bytes(const PoolPlan& plan);

/// Nothing if /dev/shm has room for them; what a broker before left there counts as room. Errors: no_space
/// (needed and available bytes named), denied.
Expected<void> check_space(const PoolPlan& plan);

/// Makes the segments at start and removes them when destroyed. Stop all processes on the bus first: those
/// that are left abort. Processes are neither monitored nor killed (a stall must not cost a live process its
/// ports).
class Broker {
 public:
  /// Errors: in_use (another broker lives), no_space (needed and available bytes named), denied (files of
  /// another user in /tmp or /dev/shm).
  static Expected<Broker> start(BrokerOptions options);
  Broker(Broker&&) noexcept;
  Broker& operator=(Broker&&) noexcept;
  ~Broker();

 private:
  struct State;
  explicit Broker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::ipc
