// What is really there, as the judges take it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace gvom::evaluation {

struct Truth {
  double resolution_m;
  std::int64_t origin[2];  ///< World voxel (R1) of column (0, 0).
  int size_x;
  int size_y;
  std::vector<float> ground_lowest;
  std::vector<float> ground_mean;
  std::vector<float> drop_m;
  std::vector<float> clearance;
  std::vector<std::uint8_t> classes;
  std::vector<std::int32_t> object;
  std::vector<std::uint8_t> drivable;
  std::vector<std::uint8_t> lethal;
  std::vector<std::uint8_t> vegetation;
};

enum class ObjectClass : std::uint8_t {
  ground = 0,
  tree = 1,
  bush = 2,
  rock = 3,
  ditch = 4,
  step_face = 5,
  overhang = 6,
  person = 7,
  grass = 8,
  wall = 9,
  car = 10,
  mirror = 11,
  dark = 12,
};

}  // namespace gvom::evaluation
