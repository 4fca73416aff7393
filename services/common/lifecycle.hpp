// Start, stop and what systemd hears of them.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include <signal.h>

namespace gvom::services {

/// How long a service on the bus may take to leave it, if it has no files to finish. The units allow a second
/// more.
inline constexpr std::chrono::milliseconds kLeaveWithin{1000};

/// Takes SIGINT and SIGTERM in a thread of its own; no other thread is ever interrupted (more than five
/// times in one of iceoryx's own waits is fatal to it). Make one first thing in main, before anything starts
/// a thread, so that every thread inherits the blocked signals. A second signal ends the process at once (128
/// + signal).
class Lifecycle {
 public:
  /// A tool takes its time to end, and a closed terminal (SIGHUP) ends it at once. A service, which has a
  /// time here, ends so long after a stop was asked for, with 0, whatever still holds it (a broker that ends
  /// at the same time, a lock), and says so; SIGHUP makes it say a word and no more.
  explicit Lifecycle(std::optional<std::chrono::milliseconds> leave_within = std::nullopt);
  ~Lifecycle();
  Lifecycle(const Lifecycle&) = delete;
  Lifecycle& operator=(const Lifecycle&) = delete;

  [[nodiscard]] bool stopping() const { return stopping_.load(std::memory_order_relaxed); }

  /// For an end that nobody planned: also true of a signal that no thread has taken yet. Takes 200 ms to say
  /// no: on a busy machine that thread may wait for the processor.
  [[nodiscard]] bool stop_asked() const;

  /// `callback` runs once, in the signal thread, when a stop is asked for (at once if it was already): wakes
  /// what the working loop waits on. Hand over an empty one before what it touches goes away; when
  /// on_stop returns, the old one is not running.
  void on_stop(std::function<void()> callback);

  /// As if a SIGTERM had come.
  void request_stop();

  /// Sleeps until the deadline (absolute, so a paced loop does not drift). False if a stop cut it short.
  bool sleep_until(std::chrono::steady_clock::time_point deadline);

 private:
  void take_signals();

  const std::optional<std::chrono::milliseconds> leave_within_;  ///< Of a service.
  sigset_t signals_;
  sigset_t previous_mask_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::mutex mutex_;
  std::condition_variable stop_asked_;
  std::function<void()> callback_;
  std::thread thread_;
};

// To systemd, by sd_notify; without NOTIFY_SOCKET they do nothing.
void notify_ready();
void notify_status(const char* text);  ///< One line for `systemctl status`.
void notify_stopping();

/// The same, for a start that waits for something else: it has half a minute from now, however long it has
/// waited.
void notify_waiting(const char* text);

/// Feeds the watchdog. Call it from the working loop itself, as often as you like: it sends at most every 100
/// ms.
void notify_watchdog();

}  // namespace gvom::services
