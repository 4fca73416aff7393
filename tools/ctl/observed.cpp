#include "tools/ctl/observed.hpp"

#include <algorithm>

#include "ipc/text.hpp"

namespace gvom::ctl {

namespace {

constexpr std::int64_t kRateOver_ns = 1'000'000'000;

}  // namespace

void Observed::add(const ipc::Health& health) {
  const auto known = std::find_if(processes_.begin(), processes_.end(), [&](const HeardProcess& process) {
    return ipc::text_of(process.newest.process) == ipc::text_of(health.process);
  });
  if (known == processes_.end()) {
    processes_.push_back({health, std::nullopt});
    return;
  }
  known->before.reset();
  if (known->newest.pid == health.pid) known->before = known->newest;
  known->newest = health;
}

void Observed::add(const ipc::MessageHeader& odometry, std::int64_t heard_mono_ns) {
  const bool anew = !odometry_ || odometry.sequence < rate_from_sequence_;
  if (anew) odometry_.emplace();
  odometry_->mono_ns = heard_mono_ns;
  const std::int64_t elapsed_ns = heard_mono_ns - rate_from_ns_;
  if (!anew && elapsed_ns < kRateOver_ns) return;
  if (!anew)
    odometry_->rate_hz =
        static_cast<double>(odometry.sequence - rate_from_sequence_) * 1e9 / static_cast<double>(elapsed_ns);
  rate_from_sequence_ = odometry.sequence;
  rate_from_ns_ = heard_mono_ns;
}

void Observed::add_refusal(const std::string& why) {
  if (std::find(refusals_.begin(), refusals_.end(), why) == refusals_.end()) refusals_.push_back(why);
}

const HeardProcess* Observed::find(const std::string& process) const {
  for (const HeardProcess& known : processes_)
    if (ipc::text_of(known.newest.process) == process) return &known;
  return nullptr;
}

}  // namespace gvom::ctl
