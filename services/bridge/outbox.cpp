#include "services/bridge/outbox.hpp"

#include <algorithm>
#include <utility>

namespace gvom::bridge {

bool Outbox::subscribe(const Subscription& subscription) {
  const bool taken = std::any_of(slots_.begin(), slots_.end(),
                                 [&](const Slot& slot) { return slot.subscription.id == subscription.id; });
  if (taken || slots_.size() == kMostSubscriptions) return false;
  slots_.push_back({subscription, 0, nullptr});
  return true;
}

std::optional<TopicId> Outbox::unsubscribe(std::uint32_t id) {
  const auto slot =
      std::find_if(slots_.begin(), slots_.end(), [&](const Slot& one) { return one.subscription.id == id; });
  if (slot == slots_.end()) return std::nullopt;
  const TopicId topic = slot->subscription.topic;
  slots_.erase(slot);
  return topic;
}

std::size_t Outbox::put(TopicId topic, std::int64_t stamp_ns, const ros::Blob& bytes) {
  std::size_t replaced = 0;
  for (Slot& slot : slots_) {
    if (slot.subscription.topic != topic) continue;
    if (slot.waiting) ++replaced;
    slot.stamp_ns = stamp_ns;
    slot.waiting = bytes;
  }
  return replaced;
}

std::optional<Outbox::Message> Outbox::take() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[next_++ % slots_.size()];
    if (slot.waiting)
      return Message{slot.subscription.id, slot.stamp_ns, std::exchange(slot.waiting, nullptr)};
  }
  return std::nullopt;
}

std::vector<TopicId> Outbox::topics() const {
  std::vector<TopicId> topics;
  for (const Slot& slot : slots_) topics.push_back(slot.subscription.topic);
  return topics;
}

}  // namespace gvom::bridge
