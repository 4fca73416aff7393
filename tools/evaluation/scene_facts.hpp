// What the judges want to know of a scene beyond its truth, found once for all of its drives.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/evaluation/frame.hpp"
#include "tools/evaluation/holes.hpp"
#include "tools/evaluation/truth.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::evaluation {

/// Metres along a ray between two points to the first solid thing; infinite if there is none before the
/// second.
using Sight = std::function<double(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m)>;

/// A tree's trunk of at least 0.15 m diameter.
struct Trunk {
  Eigen::Vector2d centre_m;
  double foot_m;  ///< Height of the ground there.
  double radius_m;
  std::vector<std::size_t> columns;  ///< Of the truth: those that it touches.
};

struct SceneFacts {
  const sim::WorldData& world;
  const Truth& truth;
  std::vector<Hole> holes;
  std::vector<std::vector<std::vector<std::size_t>>> bars;  ///< For each hole and lane: columns that bar it.
  std::vector<Trunk> trunks;
  /// Per column of the truth: way along the path to the path's nearest point, NaN beyond 1 m from the path.
  std::vector<float> path_driven_m;
  std::vector<std::uint8_t> trunk_beside;  ///< 1: a trunk in this column or one that touches it.
  std::vector<std::uint8_t> crown_beside;  ///< Likewise of foliage of a tree.
  std::vector<const sim::Object*> walkers;
};

/// Both arguments must outlive what is returned.
/// @param path_m points of the path that base_link drives, `kPathStep_m` apart
SceneFacts find_facts(const sim::WorldData& world, const Truth& truth,
                      const std::vector<Eigen::Vector2d>& path_m);

/// Where a walker is at a time after the start of the drive.
Eigen::Vector2d place_at(const sim::Object& walker, double time_s);

/// The column of the truth that holds a point, -1 outside.
std::int64_t column_at(const Truth& truth, const Eigen::Vector2d& point_m);
Eigen::Vector2d middle_of(const Truth& truth, std::size_t column);

/// Calls `visit(column of the truth, column of the frame, its middle)` where both have one.
template <typename Visit>
void for_each_column(const Truth& truth, const Frame& frame, Visit&& visit) {
  for (int y = 0; y < frame.size; ++y) {
    const std::int64_t truth_y = frame.origin[1] + y - truth.origin[1];
    if (truth_y < 0 || truth_y >= truth.size_y) continue;
    for (int x = 0; x < frame.size; ++x) {
      const std::int64_t truth_x = frame.origin[0] + x - truth.origin[0];
      if (truth_x < 0 || truth_x >= truth.size_x) continue;
      const Eigen::Vector2d middle_m((static_cast<double>(frame.origin[0] + x) + 0.5) * truth.resolution_m,
                                     (static_cast<double>(frame.origin[1] + y) + 0.5) * truth.resolution_m);
      visit(static_cast<std::size_t>(truth_y * truth.size_x + truth_x),
            static_cast<std::size_t>(y) * frame.size + x, middle_m);
    }
  }
}

/// The frame's flags at a column of the truth; 0 where the frame does not reach.
std::uint8_t flags_at(const Truth& truth, const Frame& frame, std::size_t column);
/// The frame's visibility there; unobserved where it does not reach.
std::uint8_t visibility_at(const Truth& truth, const Frame& frame, std::size_t column);

/// Whether the ground of a column can be seen from the sensor.
bool ground_in_sight(const SceneFacts& facts, const Frame& frame, const Sight& sight, std::size_t column);
/// Whether a column is out of sight behind the edge of a hole: nobody could say what is there.
bool is_behind_edge(const SceneFacts& facts, const Frame& frame, const Sight& sight, std::size_t column);

}  // namespace gvom::evaluation
