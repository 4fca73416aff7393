// Why something on the bus did not work, as a value.
#pragma once

#include <chrono>
#include <string>

#include <tl/expected.hpp>

namespace gvom::ipc {

enum class ErrorKind {
  bad_name,     ///< A name the bus would not take (empty, too long, a space, a slash, ...).
  unavailable,  ///< No broker answers, or the one we knew is gone.
  in_use,       ///< The name, or the broker's place, is taken by a living process.
  denied,       ///< Files or memory of another user or group.
  exhausted,    ///< The pool has no free chunk, or too many are held at once.
  too_large,    ///< It does not fit the pool that the configuration made for it.
  no_space,     ///< The shared-memory file system is too small for the pools.
  timeout,      ///< Nothing came in time.
  stale,        ///< What there is, is too old: Error::age.
};

struct Error {
  ErrorKind kind;
  std::string message;              ///< One line for a person: what, why, and where it helps what to do.
  std::chrono::nanoseconds age{0};  ///< Of what is stale.
};

template <typename T>
using Expected = tl::expected<T, Error>;

/// "bad_name", "unavailable", ...
const char* to_string(ErrorKind kind);

}  // namespace gvom::ipc
