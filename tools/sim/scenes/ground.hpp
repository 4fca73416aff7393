// What the scenes' ground is painted with: formulas for hills, slopes and what is dug into them.
// Metres, odom frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/sim/scenes/course.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::sim {

inline constexpr double kPlainHeight = 0.13;  ///< Of flat ground, above a face of the paper's 0.4 m voxels.
inline constexpr double kHoleDepth = 0.2;     ///< What lies as far below the ground around it is a hole.

struct GroundPoint {
  double height_m = kPlainHeight;
  Surface surface = Surface::ground;
};
using GroundFormula = std::function<GroundPoint(double x_m, double y_m)>;

/// A world without objects whose ground is the formula, `kAround` beyond the course.
WorldData paint_world(const std::string& name, const Course& course, const GroundFormula& formula,
                      double resolution_m = 0.1);

/// Bilinear, as the simulator sees it; beyond the edge that of the edge.
double height_at(const GroundMap& ground, double x_m, double y_m);

/// `ground` lowered by `depth_m`; a hole where that is deep.
GroundPoint dug(double ground_m, double depth_m);

struct ReliefShape {
  double steepest;    ///< Slope (rise over run) of the hills where they are steepest.
  double shortest_m;  ///< Wave lengths of the hills.
  double longest_m;
  double ripple_m = 0.03;  ///< Amplitude of the small waves on top, 2 to 5 m long.
};

/// Rolling ground around a course: the sum of waves in all directions, drawn from a seed.
class Relief {
 public:
  Relief(std::uint64_t seed, const Course& course, const ReliefShape& shape);

  [[nodiscard]] double height_m(double x_m, double y_m) const;

 private:
  /// amplitude * sin(number . (x, y) + phase)
  struct Wave {
    double amplitude_m;
    Eigen::Vector2d number_per_m;
    double phase;
  };

  [[nodiscard]] double steepest(double end_x_m) const;

  std::vector<Wave> waves_;
};

/// Height along x whose slope is linear between corners, constant before the first and after the last one,
/// and whose height is `kPlainHeight` at the first: ramps with rounded ends.
class SlopeProfile {
 public:
  struct Corner {
    double x_m;
    double slope;
  };
  explicit SlopeProfile(std::vector<Corner> corners) : corners_(std::move(corners)) {}

  [[nodiscard]] double height_m(double x_m) const;

 private:
  std::vector<Corner> corners_;  // by x
};

/// A ditch with vertical sides (0.1 m of run, half of it inside) and a flat bottom.
struct Ditch {
  Eigen::Vector2d middle_m;
  double turned_rad = 0.0;  ///< From square across x, about z.
  double width_m = 2.0;
  double depth_m = 1.0;
  double half_length_m = 1000.0;

  [[nodiscard]] double depth_at(double x_m, double y_m) const;
};

/// A round hole with steep sides.
struct Pothole {
  Eigen::Vector2d middle_m;
  double radius_m;
  double depth_m;

  [[nodiscard]] double depth_at(double x_m, double y_m) const;
};

/// A blot of water or of something dark on the ground: a disc with two lobes, 1.7 radii long at most.
struct Patch {
  Eigen::Vector2d middle_m;
  double radius_m;
  double turned_rad = 0.0;  ///< About z.

  [[nodiscard]] bool covers(double x_m, double y_m) const;
};

}  // namespace gvom::sim
