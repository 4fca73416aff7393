// The ground as a fine grid of heights, bilinear in between: exactly what rays meet and what the
// truth is taken from.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/sim/primitives.hpp"
#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// A rectangle of the odom frame, metres.
struct Area {
  double min_x_m;
  double min_y_m;
  double max_x_m;
  double max_y_m;
};

class Terrain {
 public:
  /// `map` has at least 2 x 2 nodes, and must outlive it.
  explicit Terrain(const GroundMap& map);

  [[nodiscard]] Area area() const;
  [[nodiscard]] double resolution_m() const { return cell_m_; }

  /// Height of the ground; outside of the area that of its edge.
  [[nodiscard]] double height_m(double x_m, double y_m) const;
  /// What the ground is at the nearest node.
  [[nodiscard]] Surface surface_at(double x_m, double y_m) const;
  /// Whether none of the four nodes around is of a hole or a face.
  [[nodiscard]] bool is_sound(double x_m, double y_m) const;
  /// Upwards, of length 1.
  [[nodiscard]] Eigen::Vector3d normal_at(double x_m, double y_m) const;

  /// Distance along the ray to where it first goes below the ground; +infinity if it does not within
  /// `max_range_m` or leaves the area.
  [[nodiscard]] double intersect(const Ray& ray, double max_range_m) const;

 private:
  /// The highest node of each square of 4^level cells; squares at the far edges may have fewer.
  struct Maxima {
    int width;
    int height;
    std::vector<float> highest_m;
  };
  /// A place within a cell, 0 .. 1 along each edge.
  struct Place {
    int ix;
    int iy;
    double fx;
    double fy;
  };

  void build_maxima();
  [[nodiscard]] const float* node(int ix, int iy) const {
    return map_.height_m.data() + static_cast<std::size_t>(iy) * (width_ + 1) + ix;
  }
  [[nodiscard]] Place place(double x_m, double y_m) const;
  [[nodiscard]] double patch_height(int ix, int iy, double cell_x, double cell_y) const;
  [[nodiscard]] double hit_in_cell(int ix, int iy, const Ray& ray, const Interval& part) const;

  const GroundMap& map_;
  double cell_m_;
  double cells_per_m_;
  int width_;                   // cells in x
  int height_;                  // cells in y
  std::vector<Maxima> levels_;  // of level 1 and up
};

}  // namespace gvom::sim
