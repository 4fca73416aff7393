// Where the bridge's messages go: Foxglove, a file, ROS 2.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "services/bridge/topic.hpp"
#include "services/common/ros/blob.hpp"

namespace gvom::bridge {

/// What became of the messages that a sink was offered, since it began.
struct SinkCounters {
  std::uint64_t sent = 0;      ///< Handed to a client, or written.
  std::uint64_t bytes = 0;     ///< Of those.
  std::uint64_t replaced = 0;  ///< By a newer one, before they could be sent.
  std::uint64_t dropped = 0;   ///< For want of room, or because sending failed.
  std::uint64_t refused = 0;   ///< Clients, or what they sent.
  std::uint64_t clients = 0;   ///< That are there now.
};

/// All functions are called by the bridge's one thread, and none of them waits for a client, a disk or a
/// network: a sink that has to wait does so in a thread of its own.
class Sink {
 public:
  virtual ~Sink() = default;

  /// One word, [a-z0-9]: "foxglove". Its counters in Health begin with it.
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Whether somebody would get a message of this topic now: asked before each is made, so it is cheap.
  [[nodiscard]] virtual bool wants(const Topic& topic) const = 0;

  /// Takes its share of the message, which nobody writes to any more. `stamp_ns`: the data's time. Called
  /// only where wants() said yes a moment ago.
  virtual void offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) = 0;

  [[nodiscard]] virtual SinkCounters counters() const = 0;

  /// Why it does not do what it should, in words with what to do; empty if all is well. The other sinks go
  /// on.
  [[nodiscard]] virtual std::string problem() const = 0;
};

}  // namespace gvom::bridge
