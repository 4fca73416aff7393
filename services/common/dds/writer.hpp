// Sends messages of one topic.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "services/common/dds/names.hpp"
#include "services/common/dds/participant.hpp"
#include "services/common/dds/qos.hpp"
#include "services/common/ros/blob.hpp"

namespace gvom::dds {

/// For one thread at a time.
class Writer {
 public:
  /// Errors: names that ROS refuses, and what Cyclone says.
  static tl::expected<Writer, std::string> open(std::shared_ptr<Participant> participant, const Topic& topic,
                                                const Qos& qos);
  ~Writer();
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;

  /// Sends it to all that listen, in this thread; waits for nobody. The blob is shared until the readers have
  /// it, or a newer one replaced it. An error: smaller than a head, larger than kLargestMessage, not sent
  /// (and why).
  tl::expected<void, std::string> write(ros::Blob cdr);

  /// Readers that are there now and take what this writer offers.
  [[nodiscard]] int subscribers() const;

  [[nodiscard]] const Guid& guid() const;

 private:
  struct State;
  explicit Writer(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace gvom::dds
