#include "services/odometry/live.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "ipc/clock.hpp"
#include "ipc/fixed.hpp"
#include "ipc/messages.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/dds/reader.hpp"
#include "services/common/dds/topic_owner.hpp"
#include "services/common/health.hpp"
#include "services/common/log.hpp"
#include "services/common/ros/schemas.hpp"
#include "services/common/words.hpp"
#include "services/odometry/live_source.hpp"
#include "services/odometry/tf_messages.hpp"

namespace gvom::odometry {
namespace {

using namespace std::chrono_literals;
using services::ExitCode;

constexpr const char* kOdometryType = "nav_msgs/msg/Odometry";
constexpr const char* kTfType = "tf2_msgs/msg/TFMessage";
constexpr dds::Qos kStanding{true, true, 256};  // of many nodes, each its newest
constexpr dds::Qos kTfQos{false, false, 256};   // many publish it
constexpr dds::Qos kQos{false, false, 32};      // a tenth of a second at 200 Hz, and more
constexpr std::int64_t kSilent_ns = 500'000'000;
constexpr std::int64_t kTold_ns = 1'000'000'000;  // how long Health tells of what was refused

/// Of this process.
struct LiveBus {
  ipc::Publisher<ipc::Odometry> odometry;
  ipc::Publisher<ipc::Health> health;

  static ipc::Expected<LiveBus> open(ipc::Runtime& runtime) {
    auto odometry = ipc::Publisher<ipc::Odometry>::open(runtime);
    if (!odometry) return tl::make_unexpected(odometry.error());
    auto health = ipc::Publisher<ipc::Health>::open(runtime);
    if (!health) return tl::make_unexpected(health.error());
    return LiveBus{std::move(*odometry), std::move(*health)};
  }
};

/// Of the topic; of tf also of the links that stand.
struct Readers {
  dds::Reader poses;
  std::optional<dds::Reader> standing;
};

class Live {
 public:
  Live(Readers readers, const LiveSource& source, std::uint64_t config_hash, ipc::Runtime& runtime,
       LiveBus& bus)
      : readers_(std::move(readers)),
        topic_(source.topic),
        bus_(bus),
        health_(runtime.name(), config_hash),
        published_(health_.counter("published")),
        refused_(health_.counter("refused_messages")),
        foreign_(health_.counter("other_publisher")),
        lost_(health_.counter("lost_messages")) {
    if (source.tf) tf_.emplace(*source.tf);
  }

  tl::expected<void, ExitCode> step() {
    while (const auto message = readers_.standing ? readers_.standing->take(0ms) : std::nullopt)
      if (const auto read = tf_->stand(bytes_of(*message)); !read) refuse(*message, read.error());
    const auto message = readers_.poses.take(100ms);
    const dds::ReaderCounters counters = readers_.poses.counters();
    lost_ = counters.lost + counters.replaced;
    if (message)
      if (const auto sent = use(*message); !sent) return sent;
    if (const std::string loss = readers_.poses.network_loss(); !loss.empty()) {
      spdlog::error("{}: {}", topic_, loss);
      return tl::unexpected(ExitCode::unavailable);
    }
    const std::int64_t now_ns = ipc::monotonic_ns();
    judge(now_ns);
    if (!health_.due(now_ns)) return {};
    if (const auto sent = bus_.health.publish(health_.take(now_ns), now_ns, epoch_); !sent)
      spdlog::warn("health: {}", sent.error().message);
    return {};
  }

 private:
  static ros::Bytes bytes_of(const dds::Message& message) {
    return {message.cdr->data(), message.cdr->size()};
  }

  /// Of tf many publish, and only those of the link that moves count.
  tl::expected<void, ExitCode> use(const dds::Message& message) {
    if (!tf_ && !is_of_owner(message)) return {};
    const auto poses = read(bytes_of(message));
    if (!poses) {
      refuse(message, poses.error());
      return {};
    }
    if (poses->empty() || (tf_ && !is_of_owner(message))) return {};
    const std::string frames = tf_ ? tf_->frames() : messages_.frames();
    if (frames != frames_) spdlog::info("{}: the pose of {}", topic_, frames);
    frames_ = frames;
    heard_ns_ = message.arrived_ns;
    for (const StampedPose& pose : *poses)
      if (const auto sent = publish(pose); !sent) return sent;
    return {};
  }

  tl::expected<std::vector<StampedPose>, std::string> read(ros::Bytes message) {
    if (tf_) return tf_->read(message);
    return messages_.read(message).map([](const StampedPose& pose) { return std::vector{pose}; });
  }

  bool is_of_owner(const dds::Message& message) {
    if (owner_.is_owner(message.publisher, message.arrived_ns)) return true;
    ++foreign_;
    foreign_ns_ = message.arrived_ns;
    return false;
  }

  void refuse(const dds::Message& message, const std::string& why) {
    ++refused_;
    refused_ns_ = message.arrived_ns;
    log_(spdlog::level::warn, "{}: a message is not used: {}", topic_, why);
  }

  tl::expected<void, ExitCode> publish(const StampedPose& pose) {
    ipc::Odometry odometry{};
    odometry.T_odom_base = record_of(pose.T_odom_base);
    const auto sent = bus_.odometry.publish(odometry, pose.stamp_ns, epoch_);
    if (!sent) {
      spdlog::error("odometry {}: {}", published_ + 1, sent.error().message);
      return tl::unexpected(services::exit_code_of(sent.error()));
    }
    published_ = *sent;
    health_.count_product();
    return {};
  }

  void judge(std::int64_t now_ns) {
    services::Words words;
    if (now_ns - heard_ns_ > kSilent_ns)
      words.add("no odometry on %s for %.1f s", topic_.c_str(),
                static_cast<double>(now_ns - heard_ns_) * 1e-9);
    if (tf_ && !tf_->missing().empty()) words.add("%s", tf_->missing().c_str());
    if (refused_ns_ != 0 && now_ns - refused_ns_ < kTold_ns)
      words.add("messages that are no pose on %s", topic_.c_str());
    if (foreign_ns_ != 0 && now_ns - foreign_ns_ < kTold_ns)
      words.add("a second publisher of %s: not used", topic_.c_str());
    health_.set_state(words.empty() ? ipc::HealthState::ok : ipc::HealthState::degraded, words.text());
  }

  Readers readers_;
  std::string topic_;
  LiveBus& bus_;
  const std::uint64_t epoch_ = static_cast<std::uint64_t>(ipc::monotonic_ns());
  OdometryMessages messages_;
  std::optional<TfMessages> tf_;
  std::string frames_;  // that the log tells of
  dds::TopicOwner owner_;
  services::LogEvery log_{std::chrono::seconds(10)};
  std::int64_t heard_ns_ = ipc::monotonic_ns();
  std::int64_t refused_ns_ = 0;
  std::int64_t foreign_ns_ = 0;
  services::HealthReport health_;
  std::uint64_t& published_;
  std::uint64_t& refused_;
  std::uint64_t& foreign_;
  std::uint64_t& lost_;
};

dds::Topic topic_of(const std::string& name, const char* type) {
  return {name, type, ros::type_hash_of(type).value_or("")};
}

tl::expected<Readers, std::string> open_readers(const LiveSource& source) {
  const auto participant = dds::Participant::open(source.network);
  if (!participant) return tl::unexpected(participant.error());
  auto poses = source.tf ? dds::Reader::open(*participant, topic_of(source.topic, kTfType), kTfQos)
                         : dds::Reader::open(*participant, topic_of(source.topic, kOdometryType), kQos);
  if (!poses) return tl::unexpected(poses.error());
  Readers readers{std::move(*poses), {}};
  if (!source.tf) return readers;
  auto standing = dds::Reader::open(*participant, topic_of(source.topic + "_static", kTfType), kStanding);
  if (!standing) return tl::unexpected(standing.error());
  readers.standing = std::move(*standing);
  return readers;
}

}  // namespace

std::string fault_of(const std::string& source) {
  const auto parsed = parse_live_source(source);
  return parsed ? "" : parsed.error();
}

ExitCode run_live(const std::string& source, std::uint64_t config_hash, ipc::Runtime& runtime,
                  services::Lifecycle& lifecycle) {
  const auto parsed = parse_live_source(source);
  if (!parsed) return ExitCode::configuration;
  auto readers = open_readers(*parsed);
  if (!readers) {
    spdlog::error("odometry source '{}': {}", source, readers.error());
    return ExitCode::unavailable;
  }
  auto bus = LiveBus::open(runtime);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  const services::BrokerWatch broker(runtime, lifecycle);
  Live live(std::move(*readers), *parsed, config_hash, runtime, *bus);
  services::notify_ready();
  while (!lifecycle.stopping()) {
    if (const auto done = live.step(); !done) return done.error();
    services::notify_watchdog();
  }
  services::notify_stopping();
  return ExitCode::ok;
}

}  // namespace gvom::odometry
