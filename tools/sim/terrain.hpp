// The ground as a fine grid of heights, bilinear in between: exactly what rays meet and what the
// truth is taken from.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/sim/landscape.hpp"
#include "tools/sim/primitives.hpp"

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
  /// Covers at least `area`, at 0.1 m.
  Terrain(const Landscape& landscape, const Area& area);

  /// Height of the ground; outside of the area that of its edge.
  [[nodiscard]] double height_m(double x_m, double y_m) const;

  /// Distance along the ray to where it first goes below the ground; +infinity if it does not within
  /// `max_range_m` or leaves the area.
  [[nodiscard]] double intersect(const Ray& ray, double max_range_m) const;

 private:
  /// The highest node of each square of 4^level cells.
  struct Maxima {
    int width;
    std::vector<float> highest_m;
  };

  void fill(const Landscape& landscape);
  void build_maxima();
  [[nodiscard]] const float* node(int ix, int iy) const {
    return nodes_.data() + static_cast<std::size_t>(iy) * (width_ + 1) + ix;
  }
  [[nodiscard]] double patch_height(int ix, int iy, double cell_x, double cell_y) const;
  [[nodiscard]] double hit_in_cell(int ix, int iy, const Ray& ray, const Interval& part) const;

  double min_x_m_;
  double min_y_m_;
  int width_;   // cells in x
  int height_;  // cells in y
  std::vector<float> nodes_;
  std::vector<Maxima> levels_;  // of level 1 and up
};

}  // namespace gvom::sim
