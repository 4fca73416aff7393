#include "tools/endurance/keeper.hpp"

#include "ipc/broker_probe.hpp"
#include "ipc/runtime.hpp"
#include "tools/common/broker_user.hpp"
#include "tools/endurance/listener.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kSilence_ns = 4 * kSecond_ns;   // of the listener
constexpr std::int64_t kPatience_ns = 5 * kSecond_ns;  // with a process, as the units have it
constexpr std::int64_t kStart_ns = 10 * kSecond_ns;    // that a process may take
constexpr std::chrono::milliseconds kLook{500};
constexpr int kDeafLooks = 3;

}  // namespace

void ListenerKeeper::step(std::int64_t now_ns) {
  if (child_ && now_ns - heard_ns_ > kSilence_ns) ended(now_ns);
  if (child_ || now_ns < next_start_ns_ || !ipc::broker_answers()) return;
  heard_ns_ = now_ns;
  child_ = std::make_unique<Child>(
      [this](int socket) { return tools::become_broker_user() ? listen_on_bus(board_, socket) : 1; });
}

void ListenerKeeper::heard(std::int64_t now_ns) {
  heard_ns_ = now_ns;
  if (joined_ns_ == 0) joined_ns_ = now_ns;
}

void ListenerKeeper::ended(std::int64_t now_ns) {
  child_.reset();
  joined_ns_ = 0;
  next_start_ns_ = now_ns + kSecond_ns / 5;
}

void Watchdog::step(std::int64_t now_ns, const HealthWatch& health, std::int64_t listener_on_bus_ns) {
  supervisor_.step();
  look_at_broker(now_ns);
  if (listener_on_bus_ns < kPatience_ns + kSecond_ns) return;
  for (const std::string& process : health.expected()) {
    const ipc::Health* const newest = health.newest(process);
    std::int64_t& killed_ns = killed_ns_[process];
    if (newest == nullptr || now_ns - newest->mono_ns < kPatience_ns || now_ns - killed_ns < kStart_ns)
      continue;
    supervisor_.kill(process);
    killed_ns = now_ns;
  }
}

void Watchdog::look_at_broker(std::int64_t now_ns) {
  if (now_ns < next_look_ns_) return;
  next_look_ns_ = now_ns + kSecond_ns;
  const bool deaf = ipc::broker_answers() && !ipc::broker_works(kLook);
  deaf_ = deaf ? deaf_ + 1 : 0;
  if (deaf_ < kDeafLooks) return;
  supervisor_.kill("gvom-roudi");
  deaf_ = 0;
}

}  // namespace gvom::endurance
