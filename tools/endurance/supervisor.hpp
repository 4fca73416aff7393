// What systemd does for the graph, where there is none: starts its processes and starts again what ended.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gvom::endurance {

class Supervisor {
 public:
  struct Place {
    std::string programs;  ///< Where they are found.
    std::string folder;    ///< In which they run.
    std::string logs;      ///< Where they leave NAME.log.
  };
  /// `arguments`: --config and so on, of all of them.
  Supervisor(const Place& place, const std::vector<std::string>& arguments,
             const std::vector<std::string>& lidars);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Call it often. When the broker is gone all others are ended and begin with it.
  void step();
  /// It makes no progress: it is killed, to be started again.
  void kill(const std::string& process);
  /// The broker last.
  void stop();

  /// Why it cannot go on: a process ended in a way that a restart does not cure.
  [[nodiscard]] const std::optional<std::string>& failure() const { return failure_; }

 private:
  struct Process {
    std::string name;  // runtime name
    std::string program;
    std::vector<std::string> arguments;
    pid_t pid = -1;
    std::int64_t next_start_ns = 0;
  };

  void start(Process& process);
  bool reap(Process& process);
  void end_all();
  void end(Process& process);
  [[nodiscard]] std::string log_of(const Process& process) const;

  Place place_;
  std::vector<Process> processes_;  // the broker first
  std::optional<std::string> failure_;
};

}  // namespace gvom::endurance
