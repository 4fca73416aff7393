// All that a planner needs: join the bus, get the newest layers, give odometry. See examples/planner.cpp.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "ipc/fixed.hpp"
#include "ipc/freshness.hpp"
#include "ipc/layers.hpp"
#include "ipc/waiter.hpp"

namespace gvom::ipc {

/// For tools that show layers however old they are.
inline constexpr std::chrono::nanoseconds kAnyAge = kUnknownAge;

/// Use it and its samples in one thread. Hold at most two samples: the pools are made for that.
class PlannerClient {
 public:
  /// `name`: this process on the bus, unique. Errors as Runtime::connect.
  static Expected<PlannerClient> connect(const std::string& name,
                                         std::chrono::milliseconds timeout = std::chrono::seconds(10));

  /// The newest layers that were not handed out yet; waits for them. Only such whose age() is at most
  /// `max_age` (kAnyAge: all) are handed out. Errors:
  ///   stale        those that came, or the last that came before, are older: stop. The message and
  ///   Error::age
  ///                say by how much. It comes as soon as that is so, not at the end of the wait; a call that
  ///                begins with nothing but stale ones waits for newer ones first
  ///   timeout      nothing new came, and the last that came are not stale yet; or none ever came
  ///   unavailable  the broker is gone: leave with _exit(75) and be started again
  Expected<LayersSample> newest_layers(std::chrono::milliseconds timeout,
                                       std::chrono::nanoseconds max_age = kDefaultMaxAge);

  /// Received, lost in gaps, refused and why.
  [[nodiscard]] const InCounters& counters() const { return layers_.counters(); }
  std::optional<std::string> new_refusal() { return layers_.new_refusal(); }

  /// T_odom_base at `stamp_ns` of the sensors' clock, where the planner's vehicle is the source of odometry.
  Expected<std::uint64_t> publish_odometry(const Odometry& odometry, std::int64_t stamp_ns,
                                           std::uint64_t epoch = 0);

  /// Makes newest_layers return early with timeout; from any thread.
  void wake() { waiter_.wake(); }
  Runtime& runtime() { return runtime_; }

 private:
  PlannerClient(Runtime runtime, LayersSubscriber layers, Waiter waiter);
  [[nodiscard]] Error nothing_new(std::chrono::milliseconds waited, std::chrono::nanoseconds max_age,
                                  std::uint64_t refused_before) const;

  Runtime runtime_;
  LayersSubscriber layers_;
  Waiter waiter_;
  std::optional<Moment> newest_received_;        // of the last layers that came
  std::optional<Publisher<Odometry>> odometry_;  // opened with the first pose
};

}  // namespace gvom::ipc
