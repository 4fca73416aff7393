#include "services/odometry/live.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <spdlog/spdlog.h>

#include "ipc/clock.hpp"
#include "ipc/fixed.hpp"
#include "ipc/messages.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/dds/network_options.hpp"
#include "services/common/dds/reader.hpp"
#include "services/common/dds/topic_owner.hpp"
#include "services/common/health.hpp"
#include "services/common/log.hpp"
#include "services/common/words.hpp"

namespace gvom::odometry {
namespace {

using namespace std::chrono_literals;
using services::ExitCode;

constexpr const char* kTypeHash = "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0";
constexpr dds::Qos kQos{false, false, 32};  // a tenth of a second at 200 Hz, and more
constexpr std::int64_t kSilent_ns = 500'000'000;
constexpr std::int64_t kTold_ns = 1'000'000'000;  // how long Health tells of what was refused

struct LiveSource {
  std::string topic;
  dds::ParticipantOptions network;
};

tl::expected<LiveSource, std::string> parse(const std::string& source) {
  const auto wrong = [&](const std::string& why) {
    return tl::unexpected("odometry source '" + source + "': " + why);
  };
  const std::size_t question = std::min(source.find('?'), source.size());
  LiveSource out;
  out.topic = source.substr(5, question - 5);
  std::map<std::string, std::string> options;
  for (std::size_t at = question; at < source.size();) {
    const std::size_t end = std::min(source.find('&', at + 1), source.size());
    const std::string option = source.substr(at + 1, end - at - 1);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string key = option.substr(0, equals);
    const bool known = dds::kNetworkOptions.count(key) != 0 && equals + 1 < option.size();
    if (!known || !options.emplace(key, option.substr(equals + 1)).second)
      return wrong("'" + option + "': expected each once of config=, distro=, domain=, interface=, peers=");
    at = end;
  }
  if (const auto name = dds::topic_on_wire(out.topic); !name) return wrong(name.error());
  auto network = dds::network_options(options, "/gvom_odometry", out.topic);
  if (!network) return wrong(network.error());
  out.network = std::move(*network);
  return out;
}

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

class Live {
 public:
  Live(dds::Reader reader, const std::string& topic, std::uint64_t config_hash, ipc::Runtime& runtime,
       LiveBus& bus)
      : reader_(std::move(reader)),
        topic_(topic),
        bus_(bus),
        health_(runtime.name(), config_hash),
        published_(health_.counter("published")),
        refused_(health_.counter("refused_messages")),
        foreign_(health_.counter("other_publisher")),
        lost_(health_.counter("lost_messages")) {}

  tl::expected<void, ExitCode> step() {
    const auto message = reader_.take(100ms);
    const dds::ReaderCounters counters = reader_.counters();
    lost_ = counters.lost + counters.replaced;
    if (message)
      if (const auto sent = use(*message); !sent) return sent;
    if (const std::string loss = reader_.network_loss(); !loss.empty()) {
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
  tl::expected<void, ExitCode> use(const dds::Message& message) {
    if (!owner_.is_owner(message.publisher, message.arrived_ns)) {
      ++foreign_;
      foreign_ns_ = message.arrived_ns;
      return {};
    }
    const bool first = messages_.frames().empty();
    const auto pose = messages_.read({message.cdr->data(), message.cdr->size()});
    if (!pose) {
      ++refused_;
      refused_ns_ = message.arrived_ns;
      log_(spdlog::level::warn, "{}: a message is not used: {}", topic_, pose.error());
      return {};
    }
    if (first) spdlog::info("{}: the pose of {}", topic_, messages_.frames());
    heard_ns_ = message.arrived_ns;
    return publish(*pose);
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
    if (refused_ns_ != 0 && now_ns - refused_ns_ < kTold_ns)
      words.add("messages that are no pose on %s", topic_.c_str());
    if (foreign_ns_ != 0 && now_ns - foreign_ns_ < kTold_ns)
      words.add("a second publisher of %s: not used", topic_.c_str());
    health_.set_state(words.empty() ? ipc::HealthState::ok : ipc::HealthState::degraded, words.text());
  }

  dds::Reader reader_;
  std::string topic_;
  LiveBus& bus_;
  const std::uint64_t epoch_ = static_cast<std::uint64_t>(ipc::monotonic_ns());
  OdometryMessages messages_;
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

tl::expected<dds::Reader, std::string> open_reader(const LiveSource& source) {
  auto participant = dds::Participant::open(source.network);
  if (!participant) return tl::unexpected(participant.error());
  return dds::Reader::open(*participant, {source.topic, "nav_msgs/msg/Odometry", kTypeHash}, kQos);
}

}  // namespace

std::string fault_of(const std::string& source) {
  const auto parsed = parse(source);
  return parsed ? "" : parsed.error();
}

ExitCode run_live(const std::string& source, std::uint64_t config_hash, ipc::Runtime& runtime,
                  services::Lifecycle& lifecycle) {
  const auto parsed = parse(source);
  if (!parsed) return ExitCode::configuration;
  auto reader = open_reader(*parsed);
  if (!reader) {
    spdlog::error("odometry source '{}': {}", source, reader.error());
    return ExitCode::unavailable;
  }
  auto bus = LiveBus::open(runtime);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  const services::BrokerWatch broker(runtime, lifecycle);
  Live live(std::move(*reader), parsed->topic, config_hash, runtime, *bus);
  services::notify_ready();
  while (!lifecycle.stopping()) {
    if (const auto done = live.step(); !done) return done.error();
    services::notify_watchdog();
  }
  services::notify_stopping();
  return ExitCode::ok;
}

}  // namespace gvom::odometry
