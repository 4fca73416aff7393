#include "ipc/waiter.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "ipc/doorbell.hpp"
#include "ipc/port_state.hpp"

namespace gvom::ipc {
namespace {

constexpr std::chrono::hours kLongestWait{24};

}  // namespace

struct Waiter::State {
  explicit State(std::shared_ptr<Doorbell> bell_) : bell(std::move(bell_)) {}

  [[nodiscard]] bool has_data() const {
    return std::any_of(ports.begin(), ports.end(), [](const auto& port) {
      const auto living = port.lock();
      return living && living->subscriber.hasData();
    });
  }

  std::shared_ptr<Doorbell> bell;
  const std::uint32_t own_set = Doorbell::process(::getpid());
  std::uint32_t sets = own_set;
  std::vector<std::weak_ptr<InPortState>> ports;
  std::atomic<bool> called{false};
};

Waiter::Waiter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Waiter::Waiter(Waiter&&) noexcept = default;
Waiter& Waiter::operator=(Waiter&&) noexcept = default;
Waiter::~Waiter() = default;

Waiter Waiter::create(Runtime& runtime) {
  return Waiter(std::make_unique<State>(runtime.doorbell()));
}

void Waiter::add(InPort& port) {
  state_->ports.push_back(port.state_);
  state_->sets |= Doorbell::readers_of(port.state_->topic.type);
}

WaitResult Waiter::wait(std::chrono::milliseconds timeout) {
  const auto deadline =
      std::chrono::steady_clock::now() +
      std::clamp<std::chrono::milliseconds>(timeout, std::chrono::milliseconds(0), kLongestWait);
  for (bool in_time = true;;) {
    const std::uint32_t rings = state_->bell->rings();
    if (state_->called.exchange(false)) return WaitResult::woken;
    if (state_->has_data()) return WaitResult::data;
    if (!in_time) return WaitResult::timeout;
    in_time = state_->bell->wait(rings, state_->sets, deadline);
  }
}

void Waiter::wake() {
  state_->called = true;
  state_->bell->ring(state_->own_set);
}

}  // namespace gvom::ipc
