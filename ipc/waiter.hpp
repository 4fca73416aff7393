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

/// Waits by CLOCK_MONOTONIC, whatever happens to the wall clock; signals do not end a wait.
class Waiter {
 public:
  static Waiter create(Runtime& runtime);
  Waiter(Waiter&&) noexcept;
  Waiter& operator=(Waiter&&) noexcept;
  ~Waiter();

  /// Waits for `subscriber` too from now on, until that is destroyed. Takes any of the subscribers, or an
  /// InPort.
  template <typename S>
  void add(S& subscriber) {
    add(subscriber.port());
  }
  void add(InPort& port);

  /// Returns at once while any subscriber has unread messages: take them all before waiting again. A day at
  /// most.
  WaitResult wait(std::chrono::milliseconds timeout);

  /// From any thread; a call while nobody waits is kept for the next wait.
  void wake();

 private:
  struct State;
  explicit Waiter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::ipc
