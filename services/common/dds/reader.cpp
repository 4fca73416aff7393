#include "services/common/dds/reader.hpp"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <utility>

#include <dds/dds.h>

#include "services/common/dds/blob_type.hpp"
#include "services/common/dds/endpoint.hpp"

namespace gvom::dds {
namespace {

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Messages on their way from Cyclone's threads to the one that takes.
class Inbox {
 public:
  explicit Inbox(std::size_t depth) : depth_(depth) {}

  /// `sequence`: its publisher's number; 0 if not known.
  void put(Message message, std::int64_t sequence) {
    {
      const std::lock_guard lock(mutex_);
      ++received_;
      count_lost(message.publisher, sequence);
      if (waiting_.size() == depth_) {
        waiting_.pop_front();
        ++replaced_;
      }
      waiting_.push_back(std::move(message));
    }
    changed_.notify_one();
  }

  std::optional<Message> take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, timeout, [&] { return !waiting_.empty(); })) return std::nullopt;
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }

  [[nodiscard]] ReaderCounters counters() const {
    const std::lock_guard lock(mutex_);
    return {received_, replaced_, lost_};
  }

 private:
  /// With mutex_. Numbers are what strangers say.
  void count_lost(std::uint64_t publisher, std::int64_t sequence) {
    constexpr std::size_t kMostPublishers = 64;
    constexpr std::int64_t kMostAtOnce = 1'000'000;
    if (sequence <= 0) return;
    if (newest_.size() == kMostPublishers && newest_.count(publisher) == 0) newest_.clear();
    std::int64_t& newest = newest_.try_emplace(publisher, sequence).first->second;
    if (sequence > newest + 1)
      lost_ += static_cast<std::uint64_t>(std::min(sequence - newest - 1, kMostAtOnce));
    newest = std::max(newest, sequence);
  }

  const std::size_t depth_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> waiting_;
  std::uint64_t received_ = 0;
  std::uint64_t replaced_ = 0;
  std::uint64_t lost_ = 0;
  std::map<std::uint64_t, std::int64_t> newest_;  // sequence, of each publisher
};

void put_all(dds_entity_t reader, Inbox& inbox) {
  constexpr std::uint32_t kAtOnce = 8;
  std::array<ddsi_serdata*, kAtOnce> messages{};
  std::array<dds_sample_info_t, kAtOnce> infos{};
  const std::int64_t arrived_ns = now_ns();
  for (;;) {
    const dds_return_t count = dds_takecdr(reader, messages.data(), kAtOnce, infos.data(), DDS_ANY_STATE);
    for (dds_return_t i = 0; i < count; ++i) {
      ros::Blob cdr = infos[i].valid_data ? blob_of(messages[i]) : nullptr;
      const std::int64_t sequence = sequence_of(messages[i]);
      ddsi_serdata_unref(messages[i]);
      if (cdr)
        inbox.put({std::move(cdr), infos[i].source_timestamp, arrived_ns, infos[i].publication_handle},
                  sequence);
    }
    if (count < static_cast<dds_return_t>(kAtOnce)) return;
  }
}

/// Cyclone calls this in a thread of its own for each message that comes. C, so no exceptions.
void on_data(dds_entity_t reader, void* inbox) noexcept {
  put_all(reader, *static_cast<Inbox*>(inbox));
}

struct ListenerDeleter {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

}  // namespace

struct Reader::State {
  explicit State(std::size_t depth) : inbox(depth) {}
  ~State() {
    if (entity.valid()) participant->remove(guid);
  }

  std::shared_ptr<Participant> participant;
  OpenTopic topic;
  Inbox inbox;
  Entity entity;  // deleted first: until then its listener runs
  Guid guid{};
};

Reader::Reader(std::unique_ptr<State> state) : state_(std::move(state)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

tl::expected<Reader, std::string> Reader::open(std::shared_ptr<Participant> participant, const Topic& topic,
                                               const Qos& qos) {
  auto opened = open_topic(participant->handle(), topic);
  if (!opened) return tl::unexpected(opened.error());
  auto state = std::make_unique<State>(static_cast<std::size_t>(qos.depth));
  state->participant = std::move(participant);
  state->topic = std::move(*opened);
  const QosPtr wanted = make_qos(qos, user_data_of(topic.type_hash, state->participant->distro()));
  const std::unique_ptr<dds_listener_t, ListenerDeleter> listener(dds_create_listener(&state->inbox));
  dds_lset_data_available(listener.get(), on_data);
  const dds_entity_t made = dds_create_reader(state->participant->handle(), state->topic.entity.get(),
                                              wanted.get(), listener.get());
  if (made < 0) return tl::unexpected("a reader of " + topic.name + ": " + dds_strretcode(made));
  state->entity = Entity(made);
  state->guid = guid_of(made);
  state->participant->add_reader(state->guid);
  return Reader(std::move(state));
}

std::optional<Message> Reader::take(std::chrono::milliseconds timeout) {
  return state_->inbox.take(timeout);
}

int Reader::publishers() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(state_->entity.get(), &status);
  return static_cast<int>(status.current_count);
}

std::string Reader::network_loss() const {
  return state_->participant->network_loss();
}

ReaderCounters Reader::counters() const {
  return state_->inbox.counters();
}

}  // namespace gvom::dds
