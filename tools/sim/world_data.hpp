// A world as data: what a scene builds, what `--world DIR` reads and `--save-world DIR` writes. Metres, odom
// frame (x forward at the start of the drive, y left, z up).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace gvom::sim {

/// What the ground is at a node of the height map. The numbers are those in `surface.npy`.
enum class Surface : std::uint8_t {
  ground = 0,  ///< What can be driven on, where it is not too steep.
  hole = 1,  ///< Below the ground around it: a ditch, a pothole, what lies below a cliff's or a bank's edge.
  face = 2,  ///< The steep side of a bank, a step, a kerb, a wall of earth.
  mirror = 3,  ///< Water: rays are mirrored.
  dark = 4,    ///< Gives no return at all.
};

/// Heights on a regular grid, bilinear in between, beyond its edge those of the edge.
struct GroundMap {
  double resolution_m = 0.1;  ///< Between nodes, x and y.
  double min_x_m = 0.0;       ///< Of node (0, 0).
  double min_y_m = 0.0;
  int nodes_x = 0;
  int nodes_y = 0;
  std::vector<float> height_m;   ///< [y][x].
  std::vector<Surface> surface;  ///< [y][x]; that of the nearest node counts.
};

enum class Kind : std::uint8_t { tree, bush, grass, rock, wall, car, branch, walker, dust };

/// A convex part of an object.
struct Body {
  enum class Shape : std::uint8_t { ellipsoid, capsule, box };

  Shape shape = Shape::ellipsoid;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< Of ellipsoid and box; the capsule's first end.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< Radii; half edges; from first to second end.
  double radius_m = 0.0;                             ///< The capsule's.
  double yaw_rad = 0.0;                              ///< The box's and the ellipsoid's, about z.
  /// Rate at which rays end inside, per metre; infinite: a solid.
  double hits_per_m = std::numeric_limits<double>::infinity();
  std::uint8_t reflectivity = 60;
};

/// Where a walker is at a time; straight and steady in between, standing before the first and after the last.
struct TrackPoint {
  double time_s;  ///< After the start of the drive.
  double x_m;
  double y_m;
};

/// A thing as a person would count it. Its place in `WorldData::objects` is its number.
struct Object {
  Kind kind = Kind::rock;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< Its foot.
  double radius_m = 0.0;                                 ///< Of trunk, bush, rock, in the plane.
  double height_m = 0.0;          ///< Above its foot; of a branch its lowest point above the ground.
  std::vector<Body> bodies;       ///< In odom; a walker's: relative to where it stands.
  std::vector<TrackPoint> track;  ///< A walker's; empty for everything else.
};

struct WorldData {
  std::string name;
  GroundMap ground;
  std::vector<Object> objects;
  /// The way of base_link, corners of a polyline that the vehicle rounds off; it drives from the first on.
  std::vector<Eigen::Vector2d> path_m;
  double rain_hits_per_m = 0.0;  ///< Rate at which rays end on drops, everywhere.
};

}  // namespace gvom::sim
