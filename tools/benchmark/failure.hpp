#pragma once

#include <string>

#include "core/backend.hpp"
#include "services/common/exit_code.hpp"

namespace gvom::bench {

/// Why there are no figures.
struct Failure {
  std::string what;
  services::ExitCode code;

  explicit Failure(const DeviceError& error) : what(error.what), code(services::ExitCode::unavailable) {}
  /// A defect of ours.
  explicit Failure(std::string defect) : what(std::move(defect)), code(services::ExitCode::internal) {}
};

}  // namespace gvom::bench
