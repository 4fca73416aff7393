#include "services/common/lifecycle.hpp"

#include <cstdio>

#include <pthread.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace gvom::services {

Lifecycle::Lifecycle() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
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
    if (stopping()) _exit(128 + signal);
    request_stop();
  }
}

void Lifecycle::request_stop() {
  const std::lock_guard lock(mutex_);
  if (stopping_.exchange(true)) return;
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
  char message[256];
  std::snprintf(message, sizeof(message), "STATUS=%s", text);
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
