// Whether `backend: auto` may use its device: not for a while after it failed again and again in flight.
#pragma once

#include <string>

#include "core/backend.hpp"
#include "services/common/device_record.hpp"

namespace gvom::services {

/// For one back end of one process. `automatic` falls back to the CPU when the device has failed in flight
/// three times within the last minute; `cuda` never does.
class DeviceTrust {
 public:
  /// @param record the file that remembers failures, see device_record_of. One that cannot be read counts as
  ///   none, and the log says so.
  DeviceTrust(Backend asked, std::string record, const BootMoment& now = BootMoment::now());

  /// What `open(which)`, one of core/open_backend.hpp, opens; `details` say so where the device is not
  /// trusted.
  template <class Open>
  auto open(Open&& open) const {
    auto opened = open(fallback_.empty() ? asked_ : Backend::cpu);
    if (opened && !fallback_.empty()) opened->details = fallback_;
    return opened;
  }

  /// Why the CPU stands in for the device, for Health; empty if it does not.
  [[nodiscard]] const std::string& fallback() const { return fallback_; }

  /// The opened device has failed in flight. Where that can't be recorded the log says so.
  void note_failure(const DeviceError& error, const BootMoment& now = BootMoment::now()) const;

 private:
  Backend asked_;
  std::string record_;
  std::string fallback_;
};

}  // namespace gvom::services
