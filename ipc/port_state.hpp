// The iceoryx side of ports. Internal to ipc/.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "iceoryx_posh/popo/untyped_publisher.hpp"
#include "iceoryx_posh/popo/untyped_subscriber.hpp"
#include "ipc/doorbell.hpp"
#include "ipc/port.hpp"

namespace gvom::ipc {

struct OutPortState {
  OutPortState(const Topic& topic_, std::shared_ptr<Doorbell> doorbell_);

  Topic topic;
  iox::popo::UntypedPublisher publisher;
  std::shared_ptr<Doorbell> doorbell;
  std::uint64_t sequence = 0;
};

struct InPortState {
  explicit InPortState(const Topic& topic_);

  /// Where a publisher's sequence stands. The oldest entry makes room for a new publisher.
  struct Origin {
    std::uint64_t id = 0;
    std::uint64_t sequence = 0;
  };

  Topic topic;
  iox::popo::UntypedSubscriber subscriber;
  InCounters counters;
  std::array<Origin, 64> origins{};
  std::size_t next_origin = 0;
  std::vector<std::string> refusals;  // not asked for yet
  std::string newest_refusal;
  std::vector<const std::uint64_t*> told;  // counters whose reason was told
};

}  // namespace gvom::ipc
