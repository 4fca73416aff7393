// The bus as gvomctl sees it: starts the process that listens there, and again when it was lost.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>

#include "tools/ctl/observed.hpp"
#include "tools/ctl/snapshot.hpp"

namespace gvom::ctl {

/// No call takes longer than its timeout and about a second, whatever the broker does. Not with threads that
/// hold locks: it forks.
class BusWatch {
 public:
  BusWatch() = default;
  ~BusWatch();
  BusWatch(const BusWatch&) = delete;
  BusWatch& operator=(const BusWatch&) = delete;

  /// Takes what comes within the timeout.
  void step(std::chrono::milliseconds timeout);

  [[nodiscard]] const Observed& observed() const { return observed_; }
  [[nodiscard]] Broker broker() const;

 private:
  void look_at_broker(std::int64_t now_ns);
  void start(std::int64_t now_ns);
  void receive(std::chrono::milliseconds timeout);
  void judge_listener(std::int64_t now_ns);
  void end_listener();

  Observed observed_;
  BrokerState state_ = BrokerState::absent;
  std::string note_;
  pid_t listener_ = -1;
  int socket_ = -1;
  bool joined_ = false;
  bool refused_ = false;  // the last listener was not let in, and said why
  std::int64_t started_ns_ = 0;
  std::int64_t heard_ns_ = 0;  // the last frame, or the start
  std::int64_t next_look_ns_ = 0;
  std::int64_t next_start_ns_ = 0;
};

}  // namespace gvom::ctl
