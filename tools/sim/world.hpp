// The simulated world: the ground, everything that stands on it, and those who walk in it.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/bin_grid.hpp"
#include "tools/sim/primitives.hpp"
#include "tools/sim/terrain.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// What a ray ends on.
struct Hit {
  double range_m;             ///< Of the whole way; +infinity: nothing.
  double cos_incidence;       ///< Of the ray and the surface's normal; 1 for leaves, dust and drops.
  std::uint8_t reflectivity;  ///< Percent.
};

class World {
 public:
  /// `data` holds at least 2 x 2 nodes of ground and two points of path.
  explicit World(WorldData data);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  [[nodiscard]] const WorldData& data() const { return data_; }
  [[nodiscard]] const Terrain& terrain() const { return terrain_; }
  /// All that stands still.
  [[nodiscard]] const std::vector<Primitive>& primitives() const { return primitives_; }
  [[nodiscard]] const BinGrid& bins() const { return bins_; }

  /// The bodies of all walkers `time_s` after the start of the drive.
  [[nodiscard]] std::vector<Primitive> walkers_at(double time_s) const;

  /// The first thing that the ray meets, within `max_range_m`. `key` decides which rays pass through what is
  /// not solid. Where the ray meets water it is mirrored and goes on: then `range_m` is the length of the
  /// whole way, which the sensor reports in the ray's own direction, so a ghost below the water.
  [[nodiscard]] Hit cast(const Ray& ray, const std::vector<Primitive>& walkers, double max_range_m,
                         std::uint64_t key) const;

 private:
  /// A straight piece of a ray's way, and whether water ends it.
  struct Leg {
    Hit hit;
    bool is_mirrored;
  };
  [[nodiscard]] Leg cast_straight(const Ray& ray, const std::vector<Primitive>& walkers, double max_range_m,
                                  std::uint64_t key) const;
  [[nodiscard]] Hit meet_bodies(const Ray& ray, const std::vector<Primitive>& walkers, double limit_m,
                                std::uint64_t key) const;

  WorldData data_;
  Terrain terrain_;
  std::vector<Primitive> primitives_;
  BinGrid bins_;
};

/// Where a walker stands at a time; `track` holds at least one point.
TrackPoint place_on(const std::vector<TrackPoint>& track, double time_s);

}  // namespace gvom::sim
