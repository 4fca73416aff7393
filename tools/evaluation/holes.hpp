// The holes that the path runs to, and from how far away a map bars the way to each.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/sim/world_data.hpp"

namespace gvom::evaluation {

/// A way of 2 m width, straight on to the hole.
struct Lane {
  double offset_m;  ///< Of its middle, to the left of the path.
  double rim_m;     ///< Where the hole begins and ends in it, from `Hole::rim_point_m` along `Hole::forward`.
  double far_rim_m;
};

/// Connected nodes of `Surface::hole`, with the faces that touch them.
struct Hole {
  Eigen::Vector2d rim_point_m;  ///< Of the path, where it meets the hole proper, behind a face; odom.
  Eigen::Vector2d forward;      ///< Of the path there: a unit vector.
  double rim_driven_m = 0.0;  ///< Way of base_link along the path to the rim, the first that 2 m width meet.
  double depth_m = 0.0;       ///< Below the ground half a metre before the rim.
  double width_m = 0.0;       ///< Along the lane nearest to the path's middle, at most `kWidestHole_m`.
  bool open = false;          ///< Wider than that in some lane, or with no far side as high: a cliff, a bank.
  std::vector<Lane> lanes;    ///< At offsets of -4 to 4 m: those into whose middle metre it reaches.
};

inline constexpr double kPathStep_m = 0.1;
inline constexpr double kWidestHole_m = 5.0;
inline constexpr double kShallowestHole_m = 0.5;

/// Holes at least `kShallowestHole_m` deep on the path or up to 6 m beyond its end, in the order in which
/// they are met.
/// @param path_m points of the path of base_link, `kPathStep_m` apart
std::vector<Hole> find_holes(const sim::GroundMap& ground, const std::vector<Eigen::Vector2d>& path_m);

/// From how far a sensor `height_m` above the ground, with beams `beam_spacing_rad` apart, can have a beam in
/// a hole of this width: sqrt(w h / b).
double range_allowed_m(double width_m, double height_m, double beam_spacing_rad);

/// What was seen of a hole's bars while the vehicle came nearer.
struct Approach {
  double distance_m;  ///< From base_link to the rim.
  bool barred;        ///< All lanes were.
};

/// The greatest distance from which on all lanes were barred, at this and all nearer ones; 0 if they were not
/// at the nearest, NaN if nothing is known.
double barred_from_m(std::vector<Approach> approaches);

}  // namespace gvom::evaluation
