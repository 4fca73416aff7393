// What grows, lies and walks along the leg of a course.
#pragma once

#include "tools/sim/scenes/planter.hpp"

namespace gvom::driving {

/// Things for each square metre of a strip; 0: none. Between two solid things a vehicle fits.
struct Cover {
  double m2_per_tree = 0;
  double m2_per_rock = 0;
  double m2_per_bush = 0;
};

/// Straight from one waypoint to the next.
struct CourseLeg {
  Eigen::Vector2d from_m;
  Eigen::Vector2d to_m;

  [[nodiscard]] Eigen::Vector2d at(double part) const { return from_m + part * (to_m - from_m); }
};

/// Also on the straight line.
void plant(sim::Planter& planter, sim::Random& random, const CourseLeg& leg, const Cover& cover);
void sow_grass(sim::Planter& planter, sim::Random& random, const CourseLeg& leg);
/// Crosses the straight line again and again, for ten minutes.
void add_walker(sim::Planter& planter, sim::Random& random, const CourseLeg& leg);
void raise_dust(sim::WorldData& world, const sim::Planter& planter, sim::Random& random,
                const CourseLeg& leg);

}  // namespace gvom::driving
