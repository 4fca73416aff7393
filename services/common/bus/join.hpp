// Joining the bus and leaving it for good, the same way in every service. Library gvom_services_bus.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <tl/expected.hpp>

#include "core/open_backend.hpp"
#include "ipc/error.hpp"
#include "ipc/runtime.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"

namespace gvom::services {

/// The code to end with when the bus said no.
ExitCode exit_code_of(const ipc::Error& error);

/// How long a process waits for the broker: under systemd (NOTIFY_SOCKET) for as long as it takes, else 10 s.
std::chrono::milliseconds broker_patience();

/// Waits for the broker up to `patience` (a stop ends the wait at once) and joins as `name`. Whoever looks at
/// the unit reads meanwhile what it waits for. What goes wrong is logged; then the code to exit with, `ok`
/// for a stop. While it joins, the process ends at once when a stop is asked for, and with 75 when the broker
/// goes, or does not answer for 10 s: iceoryx itself would wait for it for a minute. `lifecycle` outlives the
/// runtime: it says whether an error that the bus cannot go on from comes of a stop.
tl::expected<ipc::Runtime, ExitCode> join_bus(const std::string& name, Lifecycle& lifecycle,
                                              std::chrono::milliseconds patience = broker_patience());

/// Maps every page of the bus's payloads now, so that none faults later, locks the process's memory, and says
/// where the payloads lie, for a back end to reach them. What goes wrong is a warning; the memory is then
/// faulted in bit by bit, not locked, or unknown (empty).
HostMemory ready_payloads(const ipc::Runtime& runtime);

/// A thread that calls a function ten times a second, until this goes away.
class TenTimesASecond {
 public:
  explicit TenTimesASecond(std::function<void()> call);
  ~TenTimesASecond();
  TenTimesASecond(const TenTimesASecond&) = delete;
  TenTimesASecond& operator=(const TenTimesASecond&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

/// Asks ten times a second whether the broker is still there, whatever the other threads hang in. If not,
/// ends the process without destructors, which can hang, too: with 75, and the supervisor starts it anew, or
/// with 0 if it was to stop anyway.
class BrokerWatch {
 public:
  /// Both outlive it.
  BrokerWatch(const ipc::Runtime& runtime, const Lifecycle& lifecycle);
  /// The same, now: for the end of a loop that was stopped, perhaps because the broker was.
  void leave_if_gone() const;

 private:
  const ipc::Runtime& runtime_;
  const Lifecycle& lifecycle_;
  TenTimesASecond thread_;
};

}  // namespace gvom::services
