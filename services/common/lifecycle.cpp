#include "services/common/lifecycle.hpp"

#include <cerrno>
#include <cstdio>

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace gvom::services {

namespace {

/// Outlives this and main's end, where iceoryx still talks to its broker: hence detached, and without the
/// log, which is gone by then.
void leave_after(std::chrono::milliseconds time) {
  std::thread([time] {
    std::this_thread::sleep_for(time);
    ::dprintf(STDERR_FILENO, "%s: asked to stop %.1f s ago and still held by something: leaving at once\n",
              program_invocation_short_name, std::chrono::duration<double>(time).count());
    ::_exit(0);
  }).detach();
}

}  // namespace

Lifecycle::Lifecycle(std::optional<std::chrono::milliseconds> leave_within) : leave_within_(leave_within) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (leave_within_) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, &previous_mask_);
  thread_ = std::thread([this] { take_signals(); });
}

Lifecycle::~Lifecycle() {
  finished_ = true;
  pthread_kill(thread_.native_handle(), SIGTERM);  // to that thread alone: ends its sigwait
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &previous_mask_, nullptr);
}

void Lifecycle::take_signals() {
  while (true) {
    int signal = 0;
    sigwait(&signals_, &signal);
    if (finished_) return;
    if (signal == SIGHUP) {
      spdlog::warn(
          "SIGHUP: the configuration is not read again; gvomctl reload restarts whom a change concerns");
      continue;
    }
    if (stopping()) _exit(128 + signal);
    request_stop();
  }
}

bool Lifecycle::stop_asked() const {
  constexpr auto kTakesSignal = std::chrono::milliseconds(200);  // pending no more, and not known yet
  const auto is_pending = [] {
    sigset_t pending;
    return sigpending(&pending) == 0 &&
           (sigismember(&pending, SIGINT) == 1 || sigismember(&pending, SIGTERM) == 1);
  };
  if (stopping() || is_pending()) return true;
  std::this_thread::sleep_for(kTakesSignal);
  return stopping() || is_pending();
}

void Lifecycle::request_stop() {
  const std::lock_guard lock(mutex_);
  if (stopping_.exchange(true)) return;
  if (leave_within_) leave_after(*leave_within_);
  stop_asked_.notify_all();
  if (callback_) callback_();
}

void Lifecycle::on_stop(std::function<void()> callback) {
  const std::lock_guard lock(mutex_);
  callback_ = std::move(callback);
  if (callback_ && stopping()) callback_();
}

bool Lifecycle::sleep_until(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  return !stop_asked_.wait_until(lock, deadline, [this] { return stopping(); });
}

void notify_ready() {
  sd_notify(0, "READY=1");
}

void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}

void notify_status(const char* text) {
  char message[512];
  std::snprintf(message, sizeof(message), "STATUS=%s", text);
  for (char& c : message)
    if (c == '\n') c = ' ';  // another line would be another variable
  sd_notify(0, message);
}

void notify_waiting(const char* text) {
  char message[256];
  std::snprintf(message, sizeof(message), "STATUS=%s\nEXTEND_TIMEOUT_USEC=30000000", text);
  sd_notify(0, message);
}

void notify_watchdog() {
  using namespace std::chrono_literals;
  thread_local std::chrono::steady_clock::time_point next{};
  const auto now = std::chrono::steady_clock::now();
  if (now < next) return;
  next = now + 100ms;
  sd_notify(0, "WATCHDOG=1");
}

}  // namespace gvom::services
