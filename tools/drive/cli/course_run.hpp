// One of the paper's tests, with its figures.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "tools/drive/cli/campaign.hpp"
#include "tools/drive/pictures/course_figure.hpp"

namespace gvom::driving {

struct CourseRun {
  Row row;
  CourseFigures figures;
};

/// Drives `options.course` with the first seed and leaves FOLDER/COURSE.png (ways on the map's roughness,
/// distance to obstacles and cost along them), COURSE-slopes.png, COURSE.json, a strip and the log; nothing
/// where the folder is empty. The onlooker sees it, too. Errors say what could not be driven or written.
tl::expected<CourseRun, std::string> run_course(const services::VehicleConfig& config,
                                                const CampaignOptions& options,
                                                const Onlooker& onlooker = {});

/// What came of it in a line, then the driven way against that through the waypoints.
std::string text_of(const CourseRun& run);
std::string json_of(const CourseRun& run);

}  // namespace gvom::driving
