#include "services/common/device_trust.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace gvom::services {

namespace {

/// Why the device is not to be used; empty if it may be.
std::string distrust(const std::string& record, const BootMoment& now) {
  const auto failures = recent_failures(record, now);
  if (!failures) spdlog::warn("the record of the GPU's failures is not used: {}", failures.error());
  if (!failures || failures->size() < kTooManyFailures) return {};
  return fmt::format("the GPU failed {} times within a minute, so the CPU computes until a later start: {}",
                     failures->size(), failures->back().what);
}

}  // namespace

DeviceTrust::DeviceTrust(Backend asked, std::string record, const BootMoment& now)
    : asked_(asked), record_(std::move(record)) {
  if (asked_ == Backend::automatic) fallback_ = distrust(record_, now);
  if (!fallback_.empty()) spdlog::warn("{}", fallback_);
}

void DeviceTrust::note_failure(const DeviceError& error, const BootMoment& now) const {
  if (asked_ != Backend::automatic) return;
  if (const auto added = add_failure(record_, now, error.what); !added)
    spdlog::warn("the GPU's failure is not recorded, the next start will not know of it: {}", added.error());
}

}  // namespace gvom::services
