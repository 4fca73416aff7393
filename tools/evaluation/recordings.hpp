// Real recordings: what each consists of, and what is known of its place.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/vehicle_config.hpp"
#include "tools/evaluation/known_columns.hpp"

namespace gvom::evaluation {

struct Recording {
  std::string scene;
  std::string sensor;
  services::VehicleConfig vehicle;  ///< Its lidars have sources.
  std::string odometry;             ///< As OfflineMapper takes it.
  KnownColumns known;
};

struct FoundRecordings {
  std::vector<Recording> recordings;
  std::vector<std::string> missing;  ///< Folders that are not there.
};

/// Those of a directory that is laid out as $GVOM_SHARED/data. All are mapped with the same parameters; body,
/// base_height_m and the lidars' places are each recording's own. Errors name the file.
tl::expected<FoundRecordings, std::string> find_recordings(const std::string& directory,
                                                           const MapperConfig& mapper);

}  // namespace gvom::evaluation
