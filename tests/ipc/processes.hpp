// Real processes for the tests of the bus. The test program itself never joins it: children do, and tell by
// their exit code.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "ipc/broker.hpp"

/// In a child: says what was not so, and ends the child with 1.
#define EXPECT(condition)                                                          \
  do {                                                                             \
    if (!(condition)) {                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      ::_exit(1);                                                                  \
    }                                                                              \
  } while (false)

namespace gvom::ipc::test {

using namespace std::chrono_literals;

inline constexpr std::chrono::milliseconds kPatience = 60s;  // only what never comes takes that long

/// Waits until `condition` holds; false if it did not within the time.
template <typename Condition>
bool eventually(Condition condition, std::chrono::milliseconds patience = kPatience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// The next message of a subscriber, waited for.
template <typename S>
auto take_within(S& subscriber, std::chrono::milliseconds patience = kPatience) {
  auto sample = subscriber.take();
  eventually([&] { return sample || (sample = subscriber.take()); }, patience);
  return sample;
}

/// A number that processes share: how far the story has come.
class Step {
 public:
  Step() {
    void* memory = ::mmap(nullptr, sizeof(*step_), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    step_ = new (memory) std::atomic<int>(0);
  }
  ~Step() { ::munmap(step_, sizeof(*step_)); }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  void reach(int step) { *step_ = step; }
  [[nodiscard]] int now() const { return *step_; }
  [[nodiscard]] bool reached(int step) const { return now() >= step; }
  [[nodiscard]] bool wait_for(int step) const {
    return eventually([&] { return reached(step); });
  }

 private:
  std::atomic<int>* step_;
};

/// Whether a process (its first thread) sleeps, as one does that waits for something.
inline bool is_asleep(pid_t pid) {
  std::string stat;
  std::getline(std::ifstream("/proc/" + std::to_string(pid) + "/stat"), stat);
  const auto name_end = stat.rfind(')');
  return name_end != std::string::npos && stat.compare(name_end, 3, ") S") == 0;
}

/// Waits until a process has come so far that SIGTERM and SIGINT end it no more by themselves.
inline bool takes_signals(pid_t pid) {
  return eventually([pid] {
    std::ifstream status("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.rfind("SigBlk:", 0) == 0)
        return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
    return false;
  });
}

class Child {
 public:
  explicit Child(const std::function<void()>& life) : pid_(::fork()) {
    if (pid_ != 0) return;
    life();
    ::_exit(0);
  }
  ~Child() {
    if (pid_ > 0) kill();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// The exit code, or 128 + the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int kill() {
    send(SIGKILL);
    return wait();
  }
  void send(int signal) { ::kill(pid_, signal); }
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool sleeps() const {
    return eventually([this] { return is_asleep(pid_); });
  }

 private:
  pid_t pid_;
};

/// A small grid: 64 x 64 x 32 voxels, 256 bricks.
inline PoolSpec small_spec() {
  PoolSpec spec;
  spec.size_xy = 64;
  spec.size_z = 32;
  spec.lidars = 2;
  spec.buffer_size = 4;
  spec.max_returns = 10000;
  spec.max_planners = 2;
  return spec;
}

/// A broker in a process of its own, up when the constructor returns.
class BrokerProcess {
 public:
  explicit BrokerProcess(const PoolSpec& spec = small_spec()) : child_([&] { live(spec); }) {
    up_ = ready_.wait_for(1);
  }
  [[nodiscard]] bool is_up() const { return up_; }
  int stop() {
    stop_.reach(1);
    return child_.wait();
  }
  int kill() { return child_.kill(); }

 private:
  void live(const PoolSpec& spec) {
    BrokerOptions options;
    options.plan = plan_pools(spec).value();
    auto broker = Broker::start(std::move(options));
    if (!broker) std::fprintf(stderr, "%s\n", broker.error().message.c_str());
    EXPECT(broker);
    ready_.reach(1);
    while (!stop_.wait_for(1)) continue;
  }

  Step ready_;
  Step stop_;
  Child child_;
  bool up_ = false;
};

}  // namespace gvom::ipc::test
