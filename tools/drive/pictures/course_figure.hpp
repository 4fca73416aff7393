// The paper's figures of a test: the driven way against the straight one through the waypoints.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/drive/pictures/course_map.hpp"
#include "tools/drive/pictures/picture_words.hpp"
#include "tools/drive/pictures/way_figures.hpp"
#include "tools/snapshot/canvas.hpp"

namespace gvom::driving {

struct CourseFigures {
  std::vector<Eigen::Vector2d> driven_m;    ///< base_link, in truth.
  std::vector<Eigen::Vector2d> straight_m;  ///< Start and waypoints.
  WayFigures driven, straight;              ///< On the same map: that of the whole drive.
};

/// A map, borrowed, and what it costs the planner to drive there.
struct JudgedMap {
  JudgedMap(const planner::MapView& of, const planner::PlannerConfig& config);

  planner::MapView map;
  planner::Costmap costs;
};

/// By the costs of the map of the whole drive.
CourseFigures compare_ways(const JudgedMap& judged, std::vector<Eigen::Vector2d> driven_m,
                           std::vector<Eigen::Vector2d> straight_m);

/// The map's roughness with both ways, then distance to the nearest obstacle and cost along both.
snapshot::Canvas draw_course(const PictureWords& words, const JudgedMap& judged,
                             const CourseFigures& figures);

/// The slope as it was known at the start and at the end, with the driven way.
snapshot::Canvas draw_slopes(const PictureWords& words, const JudgedMap& at_start, const JudgedMap& at_end,
                             const CourseFigures& figures);

/// A line for each figure, and the same as members of a JSON object.
std::string text_of(const CourseFigures& figures);
std::string json_of(const CourseFigures& figures);

}  // namespace gvom::driving
