// A film as one picture.
#pragma once

#include <string>
#include <vector>

#include "tools/drive/pictures/film.hpp"
#include "tools/snapshot/canvas.hpp"

namespace gvom::driving {

inline constexpr int kFrame_px = 400;   ///< Edge of a frame's map.
inline constexpr double kFrame_m = 40;  ///< That it shows, the vehicle in its middle, +x right, +y up.
inline constexpr int kFramesInRow = 4;

struct StripWords {
  std::string title;     ///< What was driven.
  std::string subtitle;  ///< What came of it.
};

/// Frames in rows from the left, each with its time, speed and what the planner said: the map as it was, the
/// way driven, the path (blue), the chosen trajectory (orange), waypoints (rings), the vehicle's outline.
snapshot::Canvas draw_strip(const std::vector<const Frame*>& frames, const std::vector<Eigen::Vector2d>& way,
                            const std::vector<Eigen::Vector2d>& waypoints_m,
                            const planner::VehicleLimits& vehicle, const StripWords& words);

}  // namespace gvom::driving
