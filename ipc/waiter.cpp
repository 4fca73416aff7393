#include "ipc/waiter.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "iceoryx_posh/popo/user_trigger.hpp"
#include "iceoryx_posh/popo/wait_set.hpp"
#include "ipc/port_state.hpp"

namespace gvom::ipc {
namespace {

using std::chrono::steady_clock;

constexpr std::uint64_t kDataId = 0;
constexpr std::uint64_t kWakeId = 1;
constexpr std::uint64_t kOverdueId = 2;
constexpr std::chrono::milliseconds kLook{100};

/// Calls when a wait is overdue: those of iceoryx end by the wall clock, and one that is set back by an hour
/// would make each an hour longer.
class Guard {
 public:
  explicit Guard(iox::popo::UserTrigger& trigger) : trigger_(trigger), thread_([this] { watch(); }) {}
  ~Guard() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    stopping_.notify_all();
    thread_.join();
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  void begin(std::chrono::milliseconds timeout) {
    const auto overdue = steady_clock::now() + timeout + kLook;
    overdue_ = overdue.time_since_epoch().count();
  }
  void end() { overdue_ = 0; }

 private:
  void watch() {
    std::unique_lock lock(mutex_);
    while (!stopping_.wait_for(lock, kLook, [this] { return stop_; })) {
      const auto overdue = overdue_.load();
      if (overdue != 0 && steady_clock::now().time_since_epoch().count() > overdue) trigger_.trigger();
    }
  }

  iox::popo::UserTrigger& trigger_;
  std::atomic<steady_clock::rep> overdue_{0};  // 0: nobody waits
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace

struct Waiter::State {
  iox::popo::UserTrigger trigger;
  iox::popo::UserTrigger overdue;
  iox::popo::WaitSet<> wait_set;  // after the triggers: it lets go of them when destroyed
  Guard guard{overdue};
};

Waiter::Waiter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Waiter::Waiter(Waiter&&) noexcept = default;
Waiter& Waiter::operator=(Waiter&&) noexcept = default;
Waiter::~Waiter() = default;

Expected<Waiter> Waiter::create(Runtime&) {
  auto state = std::make_unique<State>();
  if (state->wait_set.attachEvent(state->trigger, kWakeId).has_error() ||
      state->wait_set.attachEvent(state->overdue, kOverdueId).has_error()) {
    return tl::unexpected(Error{ErrorKind::exhausted, "cannot attach the wake-up trigger"});
  }
  return Waiter(std::move(state));
}

Expected<void> Waiter::add(InPort& port) {
  auto& subscriber = port.state_->subscriber;
  if (state_->wait_set.attachState(subscriber, iox::popo::SubscriberState::HAS_DATA, kDataId).has_error()) {
    return tl::unexpected(
        Error{ErrorKind::in_use, "the subscriber is waited for already, or there are too many"});
  }
  return {};
}

WaitResult Waiter::wait(std::chrono::milliseconds timeout) {
  const auto longest = std::max(timeout, std::chrono::milliseconds(0));
  state_->guard.begin(longest);
  const auto duration = iox::units::Duration::fromMilliseconds(longest.count());
  const auto causes = state_->wait_set.timedWait(duration);
  state_->guard.end();
  const auto has = [&causes](std::uint64_t id) {
    return std::any_of(causes.begin(), causes.end(),
                       [id](const auto* cause) { return cause->getNotificationId() == id; });
  };
  if (has(kWakeId)) return WaitResult::woken;
  return has(kDataId) ? WaitResult::data : WaitResult::timeout;
}

void Waiter::wake() {
  state_->trigger.trigger();
}

}  // namespace gvom::ipc
