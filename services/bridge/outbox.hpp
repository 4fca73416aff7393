// What waits to be sent to one client: at most one message for each of its subscriptions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/bridge/foxglove_protocol.hpp"
#include "services/common/ros/blob.hpp"

namespace gvom::bridge {

class Outbox {
 public:
  static constexpr std::size_t kMostSubscriptions = 64;

  struct Message {
    std::uint32_t subscription;
    std::int64_t stamp_ns;
    ros::Blob bytes;
  };

  /// False, and nothing changes, if the id is in use or there are too many.
  bool subscribe(const Subscription& subscription);
  /// The topic that it was for; nothing if there is no such subscription. What waits for it is dropped.
  std::optional<TopicId> unsubscribe(std::uint32_t id);

  /// For each subscription of the topic; a message that waited there is replaced. Returns how many were.
  std::size_t put(TopicId topic, std::int64_t stamp_ns, const ros::Blob& bytes);

  /// The next, subscription after subscription, so that none starves another.
  std::optional<Message> take();

  /// The topics, each once for each of its subscriptions.
  [[nodiscard]] std::vector<TopicId> topics() const;

 private:
  struct Slot {
    Subscription subscription;
    std::int64_t stamp_ns = 0;
    ros::Blob waiting;
  };
  std::vector<Slot> slots_;
  std::size_t next_ = 0;
};

}  // namespace gvom::bridge
