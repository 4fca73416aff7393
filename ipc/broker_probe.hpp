// The broker looked at from outside. Joining the bus of one that hangs never ends; these always do.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace gvom::ipc {

/// True if the broker works off its messages, within `patience`: two that mean nothing to it are sent, and
/// both must be read. It reads the second only when it is through with the first, for which it needs the lock
/// that a hung one never gets. False if there is none, too.
bool broker_works(std::chrono::milliseconds patience);

/// The process that holds the broker's lock; nothing if none does, or /proc does not tell.
std::optional<pid_t> broker_pid();

/// As whom the broker runs: who else joins must have the same group, and best is the same user.
struct BrokerOwner {
  uid_t user;
  gid_t group;
};

/// Nothing if no broker's memory is there.
std::optional<BrokerOwner> broker_owner();

}  // namespace gvom::ipc
