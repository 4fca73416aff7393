#include "services/fusion/lateness.hpp"

#include <algorithm>

namespace gvom::fusion {

namespace {

constexpr std::chrono::nanoseconds kLate = ipc::kDefaultMaxAge;
constexpr std::int64_t kTold_ns = 2'000'000'000;

}  // namespace

void Lateness::took(const ipc::BrickMap& map, std::int64_t now_ns) {
  lossless_ = (map.flags & ipc::BrickMap::kLossless) != 0;
  waited_ = waited_ || (!lossless_ && now_ns - map.mono_published_ns > kLate.count());
}

void Lateness::published(const ipc::Moment& received, const ipc::Moment& now) {
  // What planners had until now was of the layers before, if those came late.
  const auto had = waited_ && received_.mono_ns != 0 ? elapsed(received_, now) : elapsed(received, now);
  waited_ = false;
  received_ = received;
  if (lossless_ || had == ipc::kUnknownAge || had <= kLate) return;
  behind_ns_ = noticed_ns_ == 0 ? had.count() : std::max<std::int64_t>(behind_ns_, had.count());
  noticed_ns_ = now.mono_ns;
}

std::chrono::nanoseconds Lateness::age(const ipc::Moment& now) const {
  return elapsed(received_, now);
}

void Lateness::describe(const ipc::Moment& now, services::Words& words) {
  if (noticed_ns_ != 0 && now.mono_ns - noticed_ns_ > kTold_ns) noticed_ns_ = 0;
  if (noticed_ns_ == 0) return;
  words.add("the layers were %.1f s behind the packets", static_cast<double>(behind_ns_) * 1e-9);
}

}  // namespace gvom::fusion
