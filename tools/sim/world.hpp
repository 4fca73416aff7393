// The simulated world: the ground, everything that stands on it, and a person who walks across.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/sim/bin_grid.hpp"
#include "tools/sim/landscape.hpp"
#include "tools/sim/primitives.hpp"
#include "tools/sim/terrain.hpp"

namespace gvom::sim {

class Random;

struct WorldParameters {
  std::uint64_t seed = 1;
  double length_m = 60.0;  ///< Of the trail that is driven.
  double speed_mps = 5.0;  ///< The person crosses just ahead of a vehicle this fast.
};

/// A thing as a person would count it; its place in `World::objects` is its number.
struct Object {
  std::string kind;            ///< "tree", "bush", "rock" or "branch".
  Eigen::Vector3d position_m;  ///< On the ground.
  double radius_m;             ///< Of trunk, bush or rock, in the plane.
  double height_m;             ///< Above the ground; of a branch its lowest point.
};

struct Hit {
  double range_m;  ///< +infinity: nothing.
  std::uint8_t reflectivity;
};

class World {
 public:
  explicit World(const WorldParameters& parameters);

  [[nodiscard]] const Landscape& landscape() const { return landscape_; }
  [[nodiscard]] const Terrain& terrain() const { return terrain_; }
  [[nodiscard]] const std::vector<Object>& objects() const { return objects_; }
  [[nodiscard]] const std::vector<Primitive>& primitives() const { return primitives_; }
  [[nodiscard]] const BinGrid& bins() const { return bins_; }
  /// Where there is truth: the trail and 50 m around it.
  [[nodiscard]] const Area& truth_area() const { return truth_area_; }

  /// The person's body `time_s` after the start of the drive.
  [[nodiscard]] Primitive person_at(double time_s) const;

  /// The first thing that the ray meets. `key` decides which rays pass through what is not solid.
  [[nodiscard]] Hit cast(const Ray& ray, const Primitive& person, double max_range_m,
                         std::uint64_t key) const;

 private:
  void plant(double from_x_m, std::uint64_t seed);
  void add_tree(Random& random, double x_m, double y_m);
  void add_bush(Random& random, double x_m, double y_m);
  void add_rock(Random& random, double x_m, double y_m);
  void add_branch();
  [[nodiscard]] bool is_free(double x_m, double y_m) const;
  [[nodiscard]] Eigen::Vector3d on_ground(double x_m, double y_m) const;

  Landscape landscape_;
  Area truth_area_;
  Terrain terrain_;
  std::vector<Object> objects_;
  std::vector<Primitive> primitives_;
  BinGrid bins_;
  double person_crossing_s_;
};

}  // namespace gvom::sim
