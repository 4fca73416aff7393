#include "tools/sim/scenes/trail_ground.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

constexpr double kCell = 0.1;
constexpr double kHeightUnits = 4096.0;  // to the metre
constexpr double kDitchRim = 0.1;        // shallower is still the rim

/// Adds the waves along one row of nodes; sin(a + b) from tables of a, so no sine per node.
struct WaveTables {
  WaveTables(const std::vector<Wave>& the_waves, double min_x_m, int count) : waves(the_waves) {
    for (const Wave& wave : waves) {
      std::vector<double> sine(count), cosine(count);
      for (int i = 0; i < count; ++i) {
        const double angle = wave.kx * (min_x_m + i * kCell);
        sine[i] = wave.amplitude_m * std::sin(angle);
        cosine[i] = wave.amplitude_m * std::cos(angle);
      }
      sines.push_back(std::move(sine));
      cosines.push_back(std::move(cosine));
    }
  }

  void add_row(double y_m, std::vector<double>& row) const {
    for (std::size_t w = 0; w < waves.size(); ++w) {
      const double sine = std::sin(waves[w].ky * y_m + waves[w].phase);
      const double cosine = std::cos(waves[w].ky * y_m + waves[w].phase);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] += sines[w][i] * cosine + cosines[w][i] * sine;
    }
  }

  const std::vector<Wave>& waves;
  std::vector<std::vector<double>> sines;
  std::vector<std::vector<double>> cosines;
};

Surface surface_at(const Landscape& landscape, double x_m, double y_m) {
  if (landscape.ditch_depth_m(x_m, y_m) > kDitchRim) return Surface::hole;
  return landscape.on_step_face(x_m, y_m) ? Surface::face : Surface::ground;
}

}  // namespace

GroundMap trail_ground(const Landscape& landscape, const Area& area) {
  GroundMap map;
  map.resolution_m = kCell;
  map.min_x_m = area.min_x_m;
  map.min_y_m = area.min_y_m;
  map.nodes_x = static_cast<int>(std::ceil((area.max_x_m - area.min_x_m) / kCell)) + 1;
  map.nodes_y = static_cast<int>(std::ceil((area.max_y_m - area.min_y_m) / kCell)) + 1;
  const WaveTables waves(landscape.waves(), map.min_x_m, map.nodes_x);
  const WaveTables ripples(landscape.ripples(), map.min_x_m, map.nodes_x);
  std::vector<double> trail_y(map.nodes_x);
  for (int i = 0; i < map.nodes_x; ++i) trail_y[i] = landscape.trail_y_m(map.min_x_m + i * kCell);

  std::vector<double> row(map.nodes_x);
  for (int iy = 0; iy < map.nodes_y; ++iy) {
    const double y = map.min_y_m + iy * kCell;
    std::fill(row.begin(), row.end(), 0.0);
    waves.add_row(y, row);
    for (int i = 0; i < map.nodes_x; ++i) row[i] *= Landscape::trail_factor(y - trail_y[i]);
    ripples.add_row(y, row);
    for (int i = 0; i < map.nodes_x; ++i) {
      const double x = map.min_x_m + i * kCell;
      const double height = row[i] + landscape.step_height_m(x, y) - landscape.ditch_depth_m(x, y);
      map.height_m.push_back(static_cast<float>(std::round(height * kHeightUnits) / kHeightUnits));
      map.surface.push_back(surface_at(landscape, x, y));
    }
  }
  return map;
}

}  // namespace gvom::sim
