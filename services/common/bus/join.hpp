// Joining the bus and leaving it for good, the same way in every service. Library gvom_services_bus.
#pragma once

#include <chrono>
#include <string>

#include <tl/expected.hpp>

#include "core/open_backend.hpp"
#include "ipc/error.hpp"
#include "ipc/runtime.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"

namespace gvom::services {

/// The code to end with when the bus said no.
ExitCode exit_code_of(const ipc::Error& error);

/// Waits for the broker up to `patience` (a stop ends the wait at once) and joins as `name`. What goes wrong
/// is logged; then the code to exit with, `ok` for a stop. While it joins, a stop ends the process at once: a
/// broker that hangs would keep it for ever.
tl::expected<ipc::Runtime, ExitCode> join_bus(const std::string& name, Lifecycle& lifecycle,
                                              std::chrono::milliseconds patience = std::chrono::seconds(10));

/// Maps every page of the bus's payloads now, so that none faults later, locks the process's memory, and says
/// where the payloads lie, for a back end to reach them. What goes wrong is a warning; the memory is then
/// faulted in bit by bit, not locked, or unknown (empty).
HostMemory ready_payloads(const ipc::Runtime& runtime);

/// Asks ten times a second at most whether the broker is still there. If not, ends the process with 75 and
/// without destructors, which can hang: the supervisor starts it anew.
class BrokerWatch {
 public:
  explicit BrokerWatch(const ipc::Runtime& runtime) : runtime_(runtime) {}
  void check();
  /// The same, now: for the end of a loop that was stopped, perhaps because the broker was.
  void leave_if_gone() const;

 private:
  const ipc::Runtime& runtime_;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace gvom::services
