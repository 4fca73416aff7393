// The plane through a column's neighbourhood (R12), from the text of core/README.md alone.
#pragma once

#include <vector>

namespace gvom::oracle {

/// A defined height of the neighbourhood: how many columns further on, and metres.
struct HeightAt {
  int dx;
  int dy;
  double z_m;
  bool remembered;
};

/// Unknown values are NaN.
struct PlaneValues {
  float slope_x, slope_y;  // m/m
  float slope;             // rad
  float roughness;         // m^2
  bool steep;
};

/// @param heights in order of dy, then of dx
/// @param resolution_m a column's edge
PlaneValues plane_through(const std::vector<HeightAt>& heights, double resolution_m, double threshold_rad);

}  // namespace gvom::oracle
