// How a publisher wakes its readers: one word of shared memory for the whole bus. Internal to ipc/.
//
// iceoryx wakes readers from within a publish, while it holds a lock that the broker needs. On a busy machine
// a woken reader takes the processor from the publisher, and if that is killed then, the lock stays locked
// for ever: one kill in about 35 did so. Rung after the publish, the bell is nobody's to hold: a kill before
// it rings costs a wake-up, and readers look at their queues at the end of each wait as well.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include "ipc/error.hpp"
#include "ipc/messages.hpp"

namespace gvom::ipc {

class Doorbell {
 public:
  /// Sets of those who listen, a bit each: the readers of a type of message, and a process (its number's set;
  /// some share one, and are woken for nothing).
  static constexpr unsigned kTypes = 12;
  static constexpr std::uint32_t readers_of(MessageType type) {
    return 1u << (static_cast<unsigned>(type) % kTypes);
  }
  static constexpr std::uint32_t process(pid_t pid) {
    return 1u << (kTypes + static_cast<unsigned>(pid) % (32 - kTypes));
  }

  /// For the broker: makes a new bell in the place of any that a dead broker left, and takes it away again.
  /// Errors: no_space, denied (another user's is in the way).
  static Expected<void> install();
  static void remove();

  /// For everybody else: the bell of the broker that is there. Errors: unavailable, denied (another group).
  static Expected<std::shared_ptr<Doorbell>> open();
  ~Doorbell();
  Doorbell(const Doorbell&) = delete;
  Doorbell& operator=(const Doorbell&) = delete;

  /// Wakes those who listen to any of `sets`. From any thread.
  void ring(std::uint32_t sets);

  /// How often it rang. Ask before looking whether there is something to do; if there is not, wait for more.
  [[nodiscard]] std::uint32_t rings() const;

  /// Sleeps until it has rung more often than `known`, for any of `sets` and now and then for others. False
  /// if `deadline` passed (or the kernel refuses).
  bool wait(std::uint32_t known, std::uint32_t sets, std::chrono::steady_clock::time_point deadline) const;

 private:
  using Word = std::atomic<std::uint32_t>;
  static_assert(sizeof(Word) == 4 && Word::is_always_lock_free, "what the kernel takes for a futex");

  explicit Doorbell(Word* word) : word_(word) {}
  Word* word_;
};

}  // namespace gvom::ipc
