// Puts things beside the trail of a scene, none in another's place.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/course.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// Where things may stand: metres from the trail, and between their edges.
struct Strip {
  double nearest_m;
  double farthest_m;
  double spacing_m = 0.5;
  double from_x_m = -kAround;
  double to_x_m = 1000.0;  ///< Or where the world ends.
};

class Planter {
 public:
  /// Both must outlive it.
  Planter(WorldData& world, const Course& course) : world_(world), course_(course) {}

  [[nodiscard]] Eigen::Vector3d on_ground(double x_m, double y_m) const;
  [[nodiscard]] double from_trail_m(double x_m, double y_m) const;

  /// True if a thing of that radius fits between what is there.
  [[nodiscard]] bool is_free(const Eigen::Vector2d& place_m, double radius_m, double spacing_m) const;

  /// Makes `count` things at drawn places of the strip, fewer if there is no room. `draw_radius` says how
  /// much room the next one takes: in plan, and from the trail.
  void scatter(Random& random, int count, const Strip& strip, const std::function<double()>& draw_radius,
               const std::function<void(const Eigen::Vector3d& foot, double radius_m)>& make);

  /// As many things as there are on average one for each `m2_per_thing`.
  [[nodiscard]] int count_for(const Strip& strip, double m2_per_thing) const;

  void add(Object object);

  /// Nothing is scattered here.
  void keep_free(const Eigen::Vector2d& place_m, double radius_m) { taken_.push_back({place_m, radius_m}); }

  void trees(Random& random, int count, const Strip& strip);
  void bushes(Random& random, int count, const Strip& strip);
  void rocks(Random& random, int count, const Strip& strip);

  /// A field of tall grass, 1 m between tussocks, none nearer to the trail than `nearest_m`.
  void grass(Random& random, const Eigen::Vector2d& middle_m, double radius_m, double nearest_m);

 private:
  struct Footprint {
    Eigen::Vector2d place_m;
    double radius_m;
  };

  WorldData& world_;
  const Course& course_;
  std::vector<Footprint> taken_;
};

}  // namespace gvom::sim
