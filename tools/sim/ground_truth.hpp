// What is really there, column by column, on the map's own grid.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/world.hpp"

namespace gvom::sim {

/// What a column is: what stands in it, else what its ground is, else what hangs over it. The numbers are
/// those in `class.npy`.
enum class ObjectClass : std::uint8_t {
  ground = 0,
  tree = 1,  ///< A trunk, or a crown that hangs lower than 2 m.
  bush = 2,
  rock = 3,
  ditch = 4,      ///< `Surface::hole`
  step_face = 5,  ///< `Surface::face`
  overhang = 6,   ///< A branch or a crown over it, and no more.
  person = 7,     ///< A walker comes through at some time.
  grass = 8,
  wall = 9,
  car = 10,
  mirror = 11,
  dark = 12,
};

/// All layers are indexed [y][x] and cover the driven path and 52 m around it, as far as the world reaches.
struct GroundTruth {
  double resolution_m;
  std::int64_t origin[2];  ///< World voxel (R1) of column (0, 0).
  int size_x;
  int size_y;
  std::vector<float> ground_lowest;  ///< Of the ground within the column, metres in odom.
  std::vector<float> ground_mean;
  /// Of a column with a node of `Surface::hole`: from the highest ground within 3 m down to its lowest,
  /// metres. Else 0.
  std::vector<float> drop_m;
  /// The lowest thing overhead (a branch at any height, else what begins 2 m above the ground), above the
  /// lowest ground, metres; else +infinity.
  std::vector<float> clearance;
  std::vector<std::uint8_t> classes;  ///< `ObjectClass`.
  std::vector<std::int32_t> object;   ///< Number of the object that gave the class, -1: none.
  /// 1 where a vehicle may drive: no hole, no face, a slope over 1.2 m below 27.5 degrees, nothing but grass
  /// and dust between 0.3 and 2 m above the ground, and around it nothing but ground, water, grass and what
  /// hangs high. Walkers do not count: they go.
  std::vector<std::uint8_t> drivable;
  /// 1 where a vehicle would be lost: a hole of 0.5 m, a face that rises by 0.5 m within 1 m, a trunk, a rock
  /// of 0.5 m, a wall, a car, a branch lower than 2 m. Where a walker is at a time is not in it.
  std::vector<std::uint8_t> lethal;
  std::vector<std::uint8_t> vegetation;  ///< 1 within or below leaves: of a bush, of grass or of a crown.
};

struct TruthOptions {
  double resolution_m;   ///< The map's.
  double seconds = 0.0;  ///< How long walkers walk.
  int threads = 1;
};

/// Samples the world every 5 cm.
GroundTruth sample_truth(const World& world, const TruthOptions& options);

}  // namespace gvom::sim
