#include "services/bridge/ros2/ros2_sink.hpp"

#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "services/common/ros/schemas.hpp"

namespace gvom::bridge {
namespace {

constexpr std::chrono::milliseconds kLook{100};    // for who listens
constexpr std::chrono::milliseconds kRetry{2000};  // where there is no network

dds::Qos qos_of(const Topic& topic) {
  constexpr int kTransforms = 100;  // as many as tf2 asks for
  return {true, topic.latched, topic.id == TopicId::tf ? kTransforms : 1};
}

}  // namespace

Ros2Sink::Ros2Sink(Ros2Settings settings) : settings_(std::move(settings)), thread_([this] { run(); }) {}

Ros2Sink::~Ros2Sink() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool Ros2Sink::wants(const Topic& topic) const {
  return slots_[static_cast<std::size_t>(topic.id)].listeners.load(std::memory_order_relaxed) != 0;
}

void Ros2Sink::offer(const Topic& topic, std::int64_t, const ros::Blob& message) {
  {
    const std::lock_guard lock(mutex_);
    auto& waiting = slot_of(topic.id).waiting;
    if (waiting.size() == static_cast<std::size_t>(qos_of(topic).depth)) {
      waiting.pop_front();
      ++counters_.replaced;
    }
    waiting.push_back(message);
    waiting_ = true;
  }
  changed_.notify_one();
}

SinkCounters Ros2Sink::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string Ros2Sink::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void Ros2Sink::set_problem(const std::string& why) {
  const std::lock_guard lock(mutex_);
  problem_ = why;
}

void Ros2Sink::run() {
  bool joined = false;
  for (;;) {
    if (!joined || is_cut_off()) joined = join();
    if (joined) count_listeners();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, joined ? kLook : kRetry, [&] { return stop_ || (joined && waiting_); });
    if (stop_) return;
    waiting_ = false;
    lock.unlock();
    if (joined) send_waiting();
  }
}

bool Ros2Sink::join() {
  leave();
  const auto opened = open_writers();
  if (!opened) leave();
  set_problem(opened ? "" : opened.error() + " (tried again every 2 s)");
  return opened.has_value();
}

bool Ros2Sink::is_cut_off() {
  const std::string why = participant_->network_loss();
  if (!why.empty()) spdlog::warn("ROS 2: {}", why);
  return !why.empty();
}

void Ros2Sink::leave() {
  for (Slot& slot : slots_) {
    slot.listeners.store(0, std::memory_order_relaxed);
    slot.writer.reset();
  }
  participant_.reset();
}

tl::expected<void, std::string> Ros2Sink::open_writers() {
  auto participant = dds::Participant::open(settings_.participant);
  if (!participant) return tl::unexpected(participant.error());
  participant_ = std::move(*participant);
  for (const TopicId id : settings_.topics) {
    const Topic& one = topic(id);
    const dds::Topic named{topic_of_node(one.name, settings_.participant.node), one.type,
                           ros::type_hash_of(one.type).value_or("")};
    auto writer = dds::Writer::open(participant_, named, qos_of(one));
    if (!writer) return tl::unexpected("ROS 2: " + writer.error());
    slot_of(id).writer.emplace(std::move(*writer));
  }
  return {};
}

void Ros2Sink::count_listeners() {
  std::uint64_t clients = 0;
  for (const TopicId id : settings_.topics) {
    Slot& slot = slot_of(id);
    const int listeners = slot.writer->subscribers();
    clients += static_cast<std::uint64_t>(listeners);
    slot.listeners.store(listeners == 0 && topic(id).latched ? -1 : listeners, std::memory_order_relaxed);
  }
  const std::lock_guard lock(mutex_);
  counters_.clients = clients;
}

std::optional<ros::Blob> Ros2Sink::next(Slot& slot) {
  const std::lock_guard lock(mutex_);
  if (slot.waiting.empty()) return std::nullopt;
  ros::Blob message = std::move(slot.waiting.front());
  slot.waiting.pop_front();
  return message;
}

/// No topic keeps the others waiting: one message of each in turn.
void Ros2Sink::send_waiting() {
  for (bool found = true; found;) {
    found = false;
    for (const TopicId id : settings_.topics) {
      Slot& slot = slot_of(id);
      const auto message = next(slot);
      if (!message) continue;
      send(slot, *message);
      found = true;
    }
  }
}

void Ros2Sink::send(Slot& slot, const ros::Blob& message) {
  const auto sent = slot.writer->write(message);
  const std::lock_guard lock(mutex_);
  if (sent) {
    ++counters_.sent;
    counters_.bytes += message->size();
    problem_.clear();
  } else {
    ++counters_.dropped;
    problem_ = "ROS 2: " + sent.error();
  }
}

}  // namespace gvom::bridge
