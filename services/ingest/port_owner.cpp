#include "services/ingest/port_owner.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::ingest {
namespace {

constexpr std::int64_t kWindow_ns = 250'000'000;
constexpr std::int64_t kPatience_ns = 1'000'000'000;
constexpr double kLeastShare = 0.25;  // packets are lost
constexpr double kMostShare = 3;      // packets come twice

int in_window(double packets_per_s) {
  return static_cast<int>(std::ceil(packets_per_s * static_cast<double>(kWindow_ns) * 1e-9));
}

}  // namespace

PortOwner::PortOwner(double least_packets_per_s, double most_packets_per_s)
    : least_(std::max(3, in_window(kLeastShare * least_packets_per_s))),
      most_(std::max(8, in_window(kMostShare * most_packets_per_s))) {}

/// The sender's place in the table; if it has none, the place of who has sent least and longest ago.
std::size_t PortOwner::rate_of(const Sender& sender) {
  const auto found = std::find_if(rates_.begin(), rates_.end(), [&](const Rate& rate) {
    return rate.heard_ns != 0 && rate.sender == sender;
  });
  if (found != rates_.end()) return static_cast<std::size_t>(found - rates_.begin());
  std::optional<std::size_t> least;
  const auto worth = [this](std::size_t i) {
    return std::make_pair(rates_[i].packets + rates_[i].before, rates_[i].heard_ns);
  };
  for (std::size_t i = 0; i < rates_.size(); ++i)
    if (i != owner_ && (!least || worth(i) < worth(*least))) least = i;
  rates_[*least] = Rate{};
  rates_[*least].sender = sender;
  return *least;
}

void PortOwner::count(Rate& rate, std::int64_t now_ns) const {
  const std::int64_t age_ns = now_ns - rate.window_ns;
  if (rate.packets == 0 || age_ns < 0 || age_ns >= kWindow_ns) {
    rate.before = age_ns >= 0 && age_ns < 2 * kWindow_ns ? rate.packets : 0;
    rate.packets = 0;
    rate.window_ns = now_ns;
  }
  ++rate.packets;
  rate.heard_ns = now_ns;
  if (rate.packets >= least_ && std::max(rate.packets, rate.before) <= most_) rate.proven_ns = now_ns;
}

/// Packets that came in bursts, because somebody was kept from work, are as good as steady ones.
void PortOwner::judge_trial(Rate& rate, std::int64_t now_ns) {
  if (rate.proven_ns != 0) return;
  const auto expected = static_cast<double>(least_) * static_cast<double>(now_ns - trial_ns_);
  const bool many = ++trial_packets_ >= least_;
  if (many && trial_packets_ * static_cast<double>(kWindow_ns) >= expected) rate.proven_ns = now_ns;
}

/// Whether the owner has lost the port to who just sent.
bool PortOwner::is_vacant(const Rate& challenger, std::int64_t now_ns) const {
  const Rate& owner = rates_[*owner_];
  if (challenger.proven_ns != now_ns) return owner.proven_ns == 0 && now_ns - owner.heard_ns > kPatience_ns;
  return owner.proven_ns == 0 || now_ns - owner.proven_ns > kPatience_ns;
}

PortOwner::Verdict PortOwner::judge(const Sender& sender, std::int64_t received_ns) {
  const std::size_t place = rate_of(sender);
  Rate& rate = rates_[place];
  count(rate, received_ns);
  const bool changes = owner_ && *owner_ != place && is_vacant(rate, received_ns);
  if (!owner_ || changes) {
    owner_ = place;
    trial_ns_ = received_ns;
    trial_packets_ = 0;
  }
  if (changes) return Verdict::new_owner;
  if (*owner_ != place) return Verdict::other;
  judge_trial(rate, received_ns);
  return rate.proven_ns != 0 || received_ns - trial_ns_ <= kPatience_ns ? Verdict::use : Verdict::slow;
}

}  // namespace gvom::ingest
