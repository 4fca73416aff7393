// Looks at a world as data: what is near its path, how steep and how deep it is.
#pragma once

#include <string>

#include "tools/sim/scene_library.hpp"
#include "tools/sim/scenes/ground.hpp"

namespace gvom::test {

/// A hash of all that a world holds.
class Fingerprint {
 public:
  std::uint64_t of(const sim::WorldData& world);

 private:
  void add(const void* bytes, std::size_t count);
  void add(double value) { add(&value, sizeof value); }

  std::uint64_t value_ = 14695981039346656037ULL;
};

/// The strip of 2 m that the vehicle drives along.
class ScenePath {
 public:
  explicit ScenePath(const sim::WorldData& world) : world_(world) {}

  [[nodiscard]] double distance_m(const Eigen::Vector2d& place_m) const;
  /// Where a solid thing that stands still is in the way below 2 m; empty: nowhere.
  [[nodiscard]] std::string first_obstacle() const;
  /// Over 1.2 m, on the middle line, but for what is within 1.2 m of a hole.
  [[nodiscard]] double steepest_deg() const;
  /// Of the middle line.
  [[nodiscard]] double share_of(sim::Surface surface) const;

 private:
  const sim::WorldData& world_;
};

/// Over 1.2 m, anywhere.
double steepest_deg(const sim::GroundMap& ground);

/// How far a hole's node is below the highest ground within 3 m along x or y, where that is least; infinite
/// without holes.
double shallowest_hole_m(const sim::GroundMap& ground);

double top_m(const sim::Object& object);
double bottom_m(const sim::Object& object);
/// Above the foot, of what is not solid.
double lowest_leaf_m(const sim::Object& object);

}  // namespace gvom::test
