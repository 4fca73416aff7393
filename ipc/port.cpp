#include "ipc/port.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "ipc/error_guard.hpp"
#include "ipc/port_state.hpp"

namespace gvom::ipc {
namespace {

constexpr std::uint64_t kLargestLoan = std::numeric_limits<std::uint32_t>::max() - 4096;

iox::capro::ServiceDescription service_of(const Topic& topic) {
  const auto id = [](const std::string& text) {
    return iox::capro::IdString_t(iox::cxx::TruncateToCapacity, text);
  };
  return {id("gvom"), id(topic.name), id(topic.instance)};
}

iox::popo::PublisherOptions publisher_options(const Topic& topic) {
  iox::popo::PublisherOptions options;
  options.historyCapacity = topic.history;
  options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::DISCARD_OLDEST_DATA;
  return options;
}

iox::popo::SubscriberOptions subscriber_options(const Topic& topic) {
  iox::popo::SubscriberOptions options;
  options.queueCapacity = topic.queue;
  options.historyRequest = topic.history;
  options.queueFullPolicy = iox::popo::QueueFullPolicy::DISCARD_OLDEST_DATA;
  return options;
}

std::string title(const Topic& topic) {
  return topic.instance == "all" ? topic.name : topic.name + "/" + topic.instance;
}

Error loan_error(const Topic& topic, std::size_t bytes, iox::popo::AllocationError reason) {
  const std::string what = title(topic) + ": no chunk of " + std::to_string(bytes) + " bytes: ";
  if (take_chunk_too_large()) {
    return {ErrorKind::too_large,
            what + "the broker's pools are smaller; was it started with another configuration?"};
  }
  if (reason == iox::popo::AllocationError::TOO_MANY_CHUNKS_ALLOCATED_IN_PARALLEL) {
    return {ErrorKind::exhausted, what + "8 are loaned already"};
  }
  return {ErrorKind::exhausted, what + "the pool is empty"};
}

/// Counts a message that is not handed out; the first time for each reason, says why.
void refuse(InPortState& state, std::uint64_t& counter, const std::string& why) {
  ++counter;
  state.newest_refusal = title(state.topic) + ": " + why;
  if (std::find(state.told.begin(), state.told.end(), &counter) != state.told.end()) return;
  state.told.push_back(&counter);
  state.refusals.push_back(state.newest_refusal);
}

void count_gap(InPortState& state, std::uint64_t origin, std::uint64_t sequence) {
  for (InPortState::Origin& known : state.origins) {
    if (known.id != origin) continue;
    if (sequence > known.sequence + 1) state.counters.lost += sequence - known.sequence - 1;
    known.sequence = sequence;
    return;
  }
  state.origins[state.next_origin] = {origin, sequence};
  state.next_origin = (state.next_origin + 1) % state.origins.size();
  ++state.counters.publishers;
}

std::uint64_t& counter_of(InCounters& counters, Refusal::Reason reason) {
  switch (reason) {
    case Refusal::Reason::foreign:
      return counters.refused_foreign;
    case Refusal::Reason::type:
      return counters.refused_type;
    case Refusal::Reason::version:
      return counters.refused_version;
    case Refusal::Reason::size:
      break;
  }
  return counters.refused_size;
}

/// True if the message is what the topic says.
bool accept(InPortState& state, const void* payload) {
  const auto* chunk = iox::mepoo::ChunkHeader::fromUserPayload(payload);
  const auto refusal =
      check_message(state.topic, static_cast<const std::byte*>(payload), chunk->userPayloadSize());
  if (!refusal || refusal->reason != Refusal::Reason::foreign) {
    count_gap(state, static_cast<std::uint64_t>(chunk->originId()),
              static_cast<const MessageHeader*>(payload)->sequence);
  }
  if (!refusal) return true;
  const bool names_release = refusal->reason == Refusal::Reason::version;
  refuse(state, counter_of(state.counters, refusal->reason),
         (names_release ? "" : "message refused: ") + refusal->why);
  return false;
}

}  // namespace

OutPortState::OutPortState(const Topic& topic_, std::shared_ptr<Doorbell> doorbell_)
    : topic(topic_),
      publisher(service_of(topic_), publisher_options(topic_)),
      doorbell(std::move(doorbell_)) {}

InPortState::InPortState(const Topic& topic_)
    : topic(topic_), subscriber(service_of(topic_), subscriber_options(topic_)) {}

Loan::Loan(std::shared_ptr<OutPortState> port, std::byte* data) : port_(std::move(port)), data_(data) {}
Loan::Loan(Loan&& other) noexcept
    : port_(std::move(other.port_)), data_(std::exchange(other.data_, nullptr)) {}

Loan& Loan::operator=(Loan&& other) noexcept {
  std::swap(port_, other.port_);
  std::swap(data_, other.data_);
  return *this;
}

Loan::~Loan() {
  if (data_ != nullptr) port_->publisher.release(data_);
}

Chunk::Chunk(std::shared_ptr<InPortState> port, const std::byte* data)
    : port_(std::move(port)), data_(data) {}
Chunk::Chunk(Chunk&& other) noexcept
    : port_(std::move(other.port_)), data_(std::exchange(other.data_, nullptr)) {}

Chunk& Chunk::operator=(Chunk&& other) noexcept {
  Chunk old(std::move(*this));
  port_ = std::move(other.port_);
  data_ = std::exchange(other.data_, nullptr);
  return *this;
}

Chunk::~Chunk() {
  if (port_ != nullptr && data_ != nullptr) port_->subscriber.release(data_);
}

std::uint64_t Chunk::publisher() const {
  if (port_ == nullptr || data_ == nullptr) return 0;
  return static_cast<std::uint64_t>(iox::mepoo::ChunkHeader::fromUserPayload(data_)->originId());
}

OutPort::OutPort(std::shared_ptr<OutPortState> state) : state_(std::move(state)) {}

Expected<OutPort> OutPort::open(Runtime& runtime, const Topic& topic) {
  return OutPort(std::make_shared<OutPortState>(topic, runtime.doorbell()));
}

Expected<Loan> OutPort::loan(std::size_t bytes) {
  if (bytes > kLargestLoan) {
    return tl::unexpected(Error{
        ErrorKind::too_large,
        title(state_->topic) + ": a message of " + std::to_string(bytes) + " bytes, at most 4 GiB can be"});
  }
  auto result = state_->publisher.loan(static_cast<std::uint32_t>(bytes), kArrayAlignment);
  if (result.has_error()) return tl::unexpected(loan_error(state_->topic, bytes, result.get_error()));
  return Loan(state_, static_cast<std::byte*>(result.value()));
}

std::uint64_t OutPort::publish(Loan&& loan, std::size_t bytes, std::int64_t stamp_ns, std::uint64_t epoch) {
  auto& header = *reinterpret_cast<MessageHeader*>(loan.data_);
  header = {kMagic,
            static_cast<std::uint16_t>(state_->topic.type),
            state_->topic.version,
            bytes,
            ++state_->sequence,
            stamp_ns,
            epoch};
  state_->publisher.publish(std::exchange(loan.data_, nullptr));
  state_->doorbell->ring(Doorbell::readers_of(state_->topic.type));
  return state_->sequence;
}

bool OutPort::has_subscribers() const {
  return state_->publisher.hasSubscribers();
}
std::uint64_t OutPort::sequence() const {
  return state_->sequence;
}

InPort::InPort(std::shared_ptr<InPortState> state) : state_(std::move(state)) {}

Expected<InPort> InPort::open(Runtime&, const Topic& topic) {
  return InPort(std::make_shared<InPortState>(topic));
}

std::optional<Chunk> InPort::take() {
  while (true) {
    auto result = state_->subscriber.take();
    if (result.has_error()) {
      if (result.get_error() == iox::popo::ChunkReceiveResult::TOO_MANY_CHUNKS_HELD_IN_PARALLEL) {
        refuse(*state_, state_->counters.refused_held,
               "message refused: this reader holds too many messages already");
      }
      return std::nullopt;
    }
    Chunk chunk(state_, static_cast<const std::byte*>(result.value()));
    if (!accept(*state_, chunk.data())) continue;
    ++state_->counters.received;
    return chunk;
  }
}

bool InPort::has_data() const {
  return state_->subscriber.hasData();
}
const InCounters& InPort::counters() const {
  return state_->counters;
}

const std::string& InPort::newest_refusal() const {
  return state_->newest_refusal;
}

std::optional<std::string> InPort::new_refusal() {
  if (state_->refusals.empty()) return std::nullopt;
  std::string refusal = std::move(state_->refusals.front());
  state_->refusals.erase(state_->refusals.begin());
  return refusal;
}

}  // namespace gvom::ipc
