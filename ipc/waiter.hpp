// Sleeps until a subscriber has data or another thread calls.
#pragma once

#include <chrono>
#include <memory>

#include "ipc/port.hpp"

namespace gvom::ipc {

enum class WaitResult {
  data,     ///< Some subscriber has unread messages.
  woken,    ///< wake() was called (there may be data too).
  timeout,  ///< Neither.
};

/// A wait is as long as asked for by CLOCK_MONOTONIC, or up to 0.2 s longer if the wall clock is set back
/// meanwhile: a thread of the waiter's own sees to it.
/// Block signals in the thread that waits: more than five interruptions in one wait end the process. Take
/// them in a sigwait thread that calls wake().
class Waiter {
 public:
  static Expected<Waiter> create(Runtime& runtime);
  Waiter(Waiter&&) noexcept;
  Waiter& operator=(Waiter&&) noexcept;
  ~Waiter();

  /// Waits for `subscriber` too from now on, until that is destroyed. Takes any of the subscribers, or an
  /// InPort.
  template <typename S>
  Expected<void> add(S& subscriber) {
    return add(subscriber.port());
  }
  Expected<void> add(InPort& port);

  /// Returns at once while any subscriber has unread messages: take them all before waiting again.
  WaitResult wait(std::chrono::milliseconds timeout);

  /// From any thread; a call while nobody waits is kept for the next wait. Not for signal handlers.
  void wake();

 private:
  struct State;
  explicit Waiter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::ipc
