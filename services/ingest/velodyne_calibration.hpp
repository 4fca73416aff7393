// The calibration that comes with each HDL-64E.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "services/ingest/velodyne_model.hpp"

namespace gvom::ingest {

/// The HDL-64E (S2, S3) whose lasers are as `path` says: a YAML file as ROS's velodyne_pointcloud has them
/// and its gen_calibration.py makes of the maker's db.xml: `lasers`, a list of 64 with `laser_id`, angles in
/// radians, lengths in metres. Errors say file, line, key and reason.
tl::expected<VelodyneModel, std::string> read_velodyne_calibration(const std::string& path);

}  // namespace gvom::ingest
