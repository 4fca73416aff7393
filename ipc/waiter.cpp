#include "ipc/waiter.hpp"

#include <algorithm>
#include <utility>

#include "iceoryx_posh/popo/user_trigger.hpp"
#include "iceoryx_posh/popo/wait_set.hpp"
#include "ipc/port_state.hpp"

namespace gvom::ipc {
namespace {

constexpr std::uint64_t kDataId = 0;
constexpr std::uint64_t kWakeId = 1;

}  // namespace

struct Waiter::State {
  iox::popo::UserTrigger trigger;
  iox::popo::WaitSet<> wait_set;  // after the trigger: it lets go of it when destroyed
};

Waiter::Waiter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Waiter::Waiter(Waiter&&) noexcept = default;
Waiter& Waiter::operator=(Waiter&&) noexcept = default;
Waiter::~Waiter() = default;

Expected<Waiter> Waiter::create(Runtime&) {
  auto state = std::make_unique<State>();
  if (state->wait_set.attachEvent(state->trigger, kWakeId).has_error()) {
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
  const auto duration = iox::units::Duration::fromMilliseconds(std::max<std::int64_t>(timeout.count(), 0));
  const auto causes = state_->wait_set.timedWait(duration);
  if (causes.empty()) return WaitResult::timeout;
  const bool woken = std::any_of(causes.begin(), causes.end(),
                                 [](const auto* cause) { return cause->getNotificationId() == kWakeId; });
  return woken ? WaitResult::woken : WaitResult::data;
}

void Waiter::wake() {
  state_->trigger.trigger();
}

}  // namespace gvom::ipc
