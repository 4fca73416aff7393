// Sends the bridge's messages to ROS 2.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <tl/expected.hpp>

#include "services/bridge/ros2/settings.hpp"
#include "services/bridge/sink.hpp"
#include "services/common/dds/writer.hpp"

namespace gvom::bridge {

/// A thread of its own joins the network, as soon as there is one, and sends; of each topic the newest
/// message waits for it, of /tf the newest hundred.
class Ros2Sink final : public Sink {
 public:
  explicit Ros2Sink(Ros2Settings settings);
  ~Ros2Sink() override;

  [[nodiscard]] std::string_view name() const override { return "ros2"; }
  /// Latched topics always: who comes next gets what was sent last.
  [[nodiscard]] bool wants(const Topic& topic) const override;
  void offer(const Topic& topic, std::int64_t stamp_ns, const ros::Blob& message) override;
  [[nodiscard]] SinkCounters counters() const override;
  [[nodiscard]] std::string problem() const override;

 private:
  struct Slot {
    std::atomic<int> listeners{0};      ///< -1: somebody may come for what is sent now.
    std::deque<ros::Blob> waiting;      ///< With mutex_.
    std::optional<dds::Writer> writer;  ///< The thread's.
  };

  Slot& slot_of(TopicId id) { return slots_[static_cast<std::size_t>(id)]; }
  void run();
  bool join();
  bool is_cut_off();
  void leave();
  tl::expected<void, std::string> open_writers();
  void send_waiting();
  void send(Slot& slot, const ros::Blob& message);
  void count_listeners();
  void set_problem(const std::string& why);
  [[nodiscard]] std::optional<ros::Blob> next(Slot& slot);

  const Ros2Settings settings_;
  std::shared_ptr<dds::Participant> participant_;  // the thread's
  std::array<Slot, kTopics.size()> slots_;
  mutable std::mutex mutex_;  // of what follows, and of what waits
  std::condition_variable changed_;
  bool stop_ = false;
  bool waiting_ = false;
  SinkCounters counters_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace gvom::bridge
