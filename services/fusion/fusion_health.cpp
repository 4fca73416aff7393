// What fusion says of itself.
#include <spdlog/spdlog.h>

#include <cstdio>
#include <string>

#include "services/common/words.hpp"
#include "services/fusion/fusion_node.hpp"

namespace gvom::fusion {

namespace {

constexpr std::int64_t kComplaintTold_ns = 2'000'000'000;

}  // namespace

void FusionNode::publish_health() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!health_.due(now_ns)) return;
  judge();
  services::notify_watchdog();
  send_health(now_ns);
}

void FusionNode::judge() {
  const ipc::Moment now = ipc::Moment::now();
  services::Words words;
  if (complaint_ns_ != 0 && now.mono_ns - complaint_ns_ < kComplaintTold_ns)
    words.add("%s", complaint_.c_str());
  unknown_.for_each(now.mono_ns, [&words](std::string_view lidar) {
    words.add("lidar %.*s is not in this configuration: its maps are not taken",
              static_cast<int>(lidar.size()), lidar.data());
  });
  const auto age = lateness_.age(now);
  const bool old = last_layers_ns_ != 0 && age > ipc::kDefaultMaxAge;
  if (old)
    words.add(fresh_ ? "the layers are %.1f s behind the packets" : "no maps: the layers are %.1f s old",
              std::chrono::duration<double>(age).count());
  if (!old || !fresh_) lateness_.describe(now, words);
  if (words.empty() && last_layers_ns_ == 0)
    return health_.set_state(ipc::HealthState::starting, "no maps yet");
  if (!device_.fallback().empty()) words.add("%s", device_.fallback().c_str());
  health_.set_state(words.empty() ? ipc::HealthState::ok : ipc::HealthState::degraded, words.text());
}

void FusionNode::send_health(std::int64_t now_ns) {
  counters_.lost_maps = bus_.inbox.lost();
  counters_.refused_maps = bus_.inbox.refused();
  counters_.report();
  const ipc::Health& health = health_.take(now_ns);
  char status[128];
  std::snprintf(status, sizeof status, "%.1f layers/s, %s, %zu maps in the window", health.rate_hz,
                services::age_text(last_layers_ns_, health.mono_ns).data(), fuser_.window().maps().size());
  services::notify_status(status);
  if (!bus_.health.publish(health, newest_stamp_ns_, epoch_))
    log_drops_(spdlog::level::warn, "a health message is lost");
}

}  // namespace gvom::fusion
