// What is found in one column of the truth.
#pragma once

#include "tools/sim/ground_truth.hpp"
#include "tools/sim/world.hpp"

namespace gvom::sim {

/// What a thing of that kind is to the truth; dust is nothing.
ObjectClass class_of(Kind kind);

/// A rectangle of ground, and what stands on it and hangs over it.
struct TruthColumn {
  double lowest_m = std::numeric_limits<double>::infinity();
  double highest_m = -std::numeric_limits<double>::infinity();
  double mean_m = 0.0;
  double overhead_m = std::numeric_limits<double>::infinity();  ///< The lowest thing that hangs here.
  int overhead_object = -1;
  ObjectClass what = ObjectClass::ground;
  int object = -1;  ///< That gave the class.
  bool is_hole = false;
  bool is_face = false;
  bool is_blocked = false;  ///< Between 0.3 and 2 m above the ground there is more than grass and dust.
  bool is_lethal = false;   ///< By what stands here.
  bool is_vegetation = false;
};

/// The square column with its lower corner at (`min_x_m`, `min_y_m`), sampled every 5 cm.
TruthColumn sample_column(const World& world, double min_x_m, double min_y_m, double edge_m);

}  // namespace gvom::sim
