// A film as one picture.
#pragma once

#include <string>
#include <vector>

#include "tools/drive/pictures/film.hpp"
#include "tools/drive/pictures/picture_words.hpp"
#include "tools/drive/true_obstacles.hpp"
#include "tools/snapshot/canvas.hpp"

namespace gvom::driving {

inline constexpr int kFrame_px = 400;   ///< Edge of a frame's map.
inline constexpr double kFrame_m = 40;  ///< That it shows, the vehicle in its middle, +x right, +y up.
inline constexpr int kFramesInRow = 4;
inline constexpr int kFirstLeft_px = 16, kFirstTop_px = 64;  ///< Of the first frame's map.
inline constexpr snapshot::Rgb kVehicleColour{60, 214, 232};

/// What lies around a drive: metres in odom.
struct Surroundings {
  std::vector<Eigen::Vector2d> way;  ///< Driven: `Film::way`.
  std::vector<Eigen::Vector2d> waypoints_m;
  std::vector<Edge> obstacles;             ///< Outlines of what truly ends a drive; may be empty.
  std::vector<std::vector<Edge>> walkers;  ///< The same of what moves, for each frame; may be empty.
};

/// Frames in rows from the left, each with its time, speed and what the planner said: the map as it was, the
/// way driven, the path (blue), the chosen trajectory (orange), waypoints (rings), true obstacles (outlines),
/// the vehicle.
snapshot::Canvas draw_strip(const std::vector<const Frame*>& frames, const Surroundings& around,
                            const planner::VehicleLimits& vehicle, const PictureWords& words);

}  // namespace gvom::driving
