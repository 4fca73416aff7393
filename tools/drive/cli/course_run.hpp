// One of the paper's tests, with its figures.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/campaign.hpp"

namespace gvom::driving {

struct CourseRun {
  Row row;
  std::string figures;  ///< The driven way against that through the waypoints, in lines.
};

/// Drives `options.course` with the first seed and leaves FOLDER/COURSE.png (ways on the map's roughness,
/// distance to obstacles and cost along them), COURSE-slopes.png, COURSE.json, a strip and the log. Errors
/// say what could not be driven or written.
tl::expected<CourseRun, std::string> run_course(const services::VehicleConfig& config,
                                                const CampaignOptions& options);

}  // namespace gvom::driving
