// Takes messages of one topic.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "services/common/dds/names.hpp"
#include "services/common/dds/participant.hpp"
#include "services/common/dds/qos.hpp"
#include "services/common/ros/blob.hpp"

namespace gvom::dds {

/// What matches every publisher, as live data should be read.
inline constexpr Qos kAnyPublisher{false, false, 5};
/// For topics whose newest message is for those who come later, such as /tf_static.
inline constexpr Qos kLatched{true, true, 1};

/// A message that came. Its bytes are somebody else's: nothing in them was looked at.
struct Message {
  ros::Blob cdr;
  std::int64_t sent_ns = 0;     ///< By the sender's wall clock, as it says.
  std::int64_t arrived_ns = 0;  ///< CLOCK_MONOTONIC, when the last of its bytes was here.
  std::uint64_t publisher = 0;  ///< The same number: the same publisher, of all that this reader hears.
};

/// What did not come to `take`.
struct ReaderCounters {
  std::uint64_t received = 0;  ///< Whole messages that came here.
  std::uint64_t replaced = 0;  ///< ... of these, not taken in time: newer ones came instead.
  std::uint64_t lost = 0;      ///< Sent between others that came, but never here as a whole.
};

/// `take` is for one thread at a time, the rest for any.
class Reader {
 public:
  /// Keeps the newest `qos.depth` messages until they are taken. Errors: names that ROS refuses, and what
  /// Cyclone says.
  static tl::expected<Reader, std::string> open(std::shared_ptr<Participant> participant, const Topic& topic,
                                                const Qos& qos = kAnyPublisher);
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  /// The oldest message that was not taken yet; waits for one up to `timeout`.
  std::optional<Message> take(std::chrono::milliseconds timeout);

  /// Publishers that are there now and offer what this reader takes.
  [[nodiscard]] int publishers() const;
  [[nodiscard]] ReaderCounters counters() const;
  /// Participant::network_loss().
  [[nodiscard]] std::string network_loss() const;

 private:
  struct State;
  explicit Reader(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace gvom::dds
