// This process's membership of the bus. One for each process, made before any port.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "ipc/clock.hpp"
#include "ipc/error.hpp"

namespace gvom::ipc {

/// Takes one line of text; may be called from any thread. Without one, lines go to stderr.
using LogSink = std::function<void(const std::string&)>;

/// True once this process was asked to stop; may be called from any thread.
using StopAsked = std::function<bool()>;

/// Longest runtime name, so that it fits Health::process.
inline constexpr std::size_t kMaxRuntimeName = 63;

/// Nothing if the bus takes `name` for a process: 1 .. 63 of [A-Za-z0-9_.-], not starting with a dot, not
/// "roudi".
Expected<void> check_runtime_name(const std::string& name);

/// True if a broker's socket takes messages at this moment. Costs a few microseconds.
bool broker_answers();

/// A stretch of this process's address space.
struct MemoryRange {
  std::byte* base = nullptr;
  std::size_t bytes = 0;
};

class Doorbell;

class Runtime {
 public:
  /// Joins the bus as `name`, waiting up to `timeout` for the broker. Errors: bad_name, unavailable, in_use
  /// (a living process has the name, or this process has joined already), denied.
  ///
  /// From here on the bus's own errors come to `log`; one that it cannot go on from ends the process with
  /// exit code 70 at once, without destructors (they can hang), after saying why: the supervisor restarts it.
  /// If `stop_asked` says so it ends with 0 instead, as a process does that is stopped together with its
  /// broker. Both must live as long as the runtime.
  static Expected<Runtime> connect(const std::string& name, std::chrono::milliseconds timeout,
                                   LogSink log = {}, StopAsked stop_asked = {});

  Runtime(Runtime&&) noexcept;
  Runtime& operator=(Runtime&&) noexcept;
  ~Runtime();

  [[nodiscard]] const std::string& name() const;

  /// False once the broker that we joined is gone, though another may have come: ports never reconnect, so
  /// leave with `_exit(75)` (destructors can hang) and be started again. Cheap enough for 10 Hz.
  [[nodiscard]] bool broker_alive() const;

  /// Where all payloads live in this process: what a GPU back end pins.
  [[nodiscard]] Expected<MemoryRange> payload_segment() const;

  /// Maps every page of the payload segment now, so that none faults later. Returns the bytes.
  [[nodiscard]] Expected<std::size_t> prefault() const;

 private:
  friend class OutPort;
  friend class Waiter;
  struct State;
  explicit Runtime(std::unique_ptr<State> state);
  [[nodiscard]] const std::shared_ptr<Doorbell>& doorbell() const;
  std::unique_ptr<State> state_;
};

}  // namespace gvom::ipc
