// Ditches across the path, which ends 3 m before them. Their names give the width; a, b and c are the height
// of the ground above a face of the paper's voxels: where that is matters to a map.
#include <cmath>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/scenes.hpp"

namespace gvom::sim {
namespace {

constexpr double kPhaseA = 0.01;
constexpr double kPhaseB = 0.13;
constexpr double kPhaseC = 0.33;

constexpr double kTan10 = 0.17632698070846;    // degrees
constexpr double kOblique = 0.61086523819802;  // 35 degrees

struct Section {
  double width_m;
  double depth_m;
};
constexpr Section kWide{2.0, 1.0};
constexpr Section kNarrow{1.0, 0.6};

/// Its rim crosses the path at `kEnd`.
Ditch across_the_end(const Section& section, double turned_rad = 0.0) {
  Ditch ditch;
  ditch.middle_m = {kEnd + 0.5 * section.width_m / std::cos(turned_rad), 0.0};
  ditch.turned_rad = turned_rad;
  ditch.width_m = section.width_m;
  ditch.depth_m = section.depth_m;
  return ditch;
}

WorldData make_level(const char* name, const Section& section, double height_m) {
  const Ditch ditch = across_the_end(section);
  return paint_world(name, straight_course(kEndingPath),
                     [&](double x, double y) { return dug(height_m, ditch.depth_at(x, y)); });
}

WorldData make_inclined(const char* name, double slope) {
  const Ditch ditch = across_the_end(kWide);
  return paint_world(name, straight_course(kEndingPath),
                     [&](double x, double y) { return dug(kPlainHeight + slope * x, ditch.depth_at(x, y)); });
}

}  // namespace

WorldData make_ditch_2m_a(const SceneParameters&) {
  return make_level("ditch-2m-a", kWide, kPhaseA);
}

WorldData make_ditch_2m_b(const SceneParameters&) {
  return make_level("ditch-2m-b", kWide, kPhaseB);
}

WorldData make_ditch_2m_c(const SceneParameters&) {
  return make_level("ditch-2m-c", kWide, kPhaseC);
}

WorldData make_ditch_1m_a(const SceneParameters&) {
  return make_level("ditch-1m-a", kNarrow, kPhaseA);
}

WorldData make_ditch_1m_b(const SceneParameters&) {
  return make_level("ditch-1m-b", kNarrow, kPhaseB);
}

WorldData make_ditch_1m_c(const SceneParameters&) {
  return make_level("ditch-1m-c", kNarrow, kPhaseC);
}

WorldData make_ditch_oblique(const SceneParameters&) {
  const Ditch ditch = across_the_end(kWide, kOblique);
  return paint_world("ditch-oblique", straight_course(kEndingPath),
                     [&](double x, double y) { return dug(kPlainHeight, ditch.depth_at(x, y)); });
}

WorldData make_ditch_slope(const SceneParameters&) {
  return make_inclined("ditch-slope", kTan10);
}

WorldData make_ditch_slope_down(const SceneParameters&) {
  return make_inclined("ditch-slope-down", -kTan10);
}

WorldData make_ditch_rough(const SceneParameters& parameters) {
  const Course course = straight_course(kEndingPath);
  const Relief relief(derive(parameters.seed, 0xD17C4), course, {0.12, 10.0, 40.0});
  const Ditch ditch = across_the_end(kWide);
  return paint_world("ditch-rough", course,
                     [&](double x, double y) { return dug(relief.height_m(x, y), ditch.depth_at(x, y)); });
}

}  // namespace gvom::sim
