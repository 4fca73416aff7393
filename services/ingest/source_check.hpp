// What --check finds at a lidar's source, before anything runs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/config_file.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

struct CheckedSource {
  std::unique_ptr<Source> source;     ///< Open: keeps a port.
  std::string found;                  ///< "12345 returns in 1024 columns, ...", or that a port can be bound.
  std::vector<std::string> warnings;  ///< What opening and decoding had to say.
};

/// Opens the source of `lidar`. Of a recording it decodes the first sweeps, three at most, and tells of the
/// fullest. An error too if there is none, or they all have too few of their columns. Of a sensor it binds
/// the port.
tl::expected<CheckedSource, SourceError> check_source(const services::LidarConfig& lidar);

/// An error where the file names no source for `lidar`.
tl::expected<void, services::ConfigError> check_given(const services::VehicleConfig& config,
                                                      const services::LidarConfig& lidar);

}  // namespace gvom::ingest
