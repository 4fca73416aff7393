// Keeps our own listener on the bus, and, where systemd does not, sees to it that nothing hangs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "tools/endurance/board.hpp"
#include "tools/endurance/child.hpp"
#include "tools/endurance/health_watch.hpp"
#include "tools/endurance/supervisor.hpp"

namespace gvom::endurance {

/// The listener, started again when it left or hangs with its broker.
class ListenerKeeper {
 public:
  explicit ListenerKeeper(Board& board) : board_(board) {}

  void step(std::int64_t now_ns);
  void heard(std::int64_t now_ns);  ///< A note of it came.
  void ended(std::int64_t now_ns);  ///< It left.

  [[nodiscard]] int socket() const { return child_ ? child_->socket() : -1; }
  [[nodiscard]] pid_t pid() const { return child_ ? child_->pid() : -1; }
  /// How long it has been on the bus; 0 if it is not.
  [[nodiscard]] std::int64_t on_bus_ns(std::int64_t now_ns) const {
    return joined_ns_ == 0 ? 0 : now_ns - joined_ns_;
  }

 private:
  Board& board_;
  std::unique_ptr<Child> child_;
  std::int64_t joined_ns_ = 0;
  std::int64_t heard_ns_ = 0;
  std::int64_t next_start_ns_ = 0;
};

/// What systemd's watchdog does for the units: a process that makes no turn of its loop is killed.
class Watchdog {
 public:
  explicit Watchdog(Supervisor& supervisor) : supervisor_(supervisor) {}
  void step(std::int64_t now_ns, const HealthWatch& health, std::int64_t listener_on_bus_ns);

 private:
  void look_at_broker(std::int64_t now_ns);

  Supervisor& supervisor_;
  std::map<std::string, std::int64_t> killed_ns_;
  std::int64_t next_look_ns_ = 0;
  int deaf_ = 0;  // looks in a row at which the broker read nothing
};

}  // namespace gvom::endurance
