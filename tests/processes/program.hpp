// Our executables as children, what they say in a file.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace gvom::test {

/// What a program that did not end within the patience counts as having exited with.
inline constexpr int kHung = -1;

class Program {
 public:
  /// Starts our executable `name` in `folder`, where its relative paths begin. It dies with the test.
  Program(const std::string& name, const std::vector<std::string>& arguments, std::string folder);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// The exit code, 128 + the signal that ended it, or kHung (and then it is killed).
  int wait(std::chrono::milliseconds patience = std::chrono::seconds(240));
  int stop(int signal = SIGTERM);  ///< And wait().
  void send(int signal) const;
  int kill();
  /// As kill(), but while its main thread sleeps: in iceoryx 2.0 a process that dies within publish() leaves
  /// locks behind that the broker then waits for.
  int kill_asleep();

  [[nodiscard]] bool runs();
  [[nodiscard]] bool says(const std::string& words,
                          std::chrono::milliseconds patience = std::chrono::seconds(60)) const;
  [[nodiscard]] std::string output() const;
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  bool reap(int flags);

  std::string log_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int code_ = 0;
};

/// How a program that ends by itself went.
struct Ended {
  int code;
  std::string output;
};

Ended run(const std::string& name, const std::vector<std::string>& arguments, const std::string& folder);

}  // namespace gvom::test
