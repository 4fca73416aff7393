// Ground that can be driven on everywhere, and nothing else.
#include <cmath>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/scenes.hpp"

namespace gvom::sim {
namespace {

constexpr double kTan14 = 0.24932800284318;  // degrees
constexpr double kTan15 = 0.26794919243112;

constexpr double kRampBegin = 15.0;
constexpr double kRampLength = 20.0;  // with its rounded ends
constexpr double kRadius = 8.0;       // of what is rounded, as nature or a road builder leaves it
constexpr double kRampRounding = kRadius * kTan15;
constexpr double kSharp = 0.1;  // one node

constexpr double kCrestX = 20.0;
constexpr double kCrestHalf = 12.0;
constexpr double kCrestRounding = kRadius * kTan14;

/// @param edge_m how long the first of its two ends is
WorldData make_ramp(const char* name, const SceneParameters& parameters, double slope, double edge_m) {
  const SlopeProfile profile({{kRampBegin, 0.0},
                              {kRampBegin + edge_m, slope},
                              {kRampBegin + kRampLength - kRampRounding, slope},
                              {kRampBegin + kRampLength, 0.0}});
  return paint_world(name, straight_course(parameters.length_m),
                     [&](double x, double) { return GroundPoint{profile.height_m(x)}; });
}

/// A bump across the trail, a full wave of a cosine.
struct Bump {
  double x_m;
  double length_m;
  double height_m;

  [[nodiscard]] double height_at(double x) const {
    constexpr double kTurn = 6.283185307179586;
    const double at = (x - x_m) / length_m;
    return std::abs(at) < 0.5 ? 0.5 * height_m * (1.0 + std::cos(kTurn * at)) : 0.0;
  }
};

}  // namespace

WorldData make_flat(const SceneParameters& parameters) {
  return paint_world("flat", straight_course(parameters.length_m),
                     [](double, double) { return GroundPoint{}; });
}

WorldData make_hills(const SceneParameters& parameters) {
  const Course course = straight_course(parameters.length_m);
  const Relief relief(derive(parameters.seed, 0x4111), course,
                      {0.42, 18.0, 70.0});  // with the ripples to 25 degrees
  return paint_world("hills", course, [&](double x, double y) { return GroundPoint{relief.height_m(x, y)}; });
}

WorldData make_ramp_up(const SceneParameters& parameters) {
  return make_ramp("ramp-up", parameters, kTan15, kRampRounding);
}

WorldData make_ramp_down(const SceneParameters& parameters) {
  return make_ramp("ramp-down", parameters, -kTan15, kRampRounding);
}

WorldData make_ramp_sharp(const SceneParameters& parameters) {
  return make_ramp("ramp-sharp", parameters, -kTan15, kSharp);
}

WorldData make_sidehill(const SceneParameters& parameters) {
  return paint_world("sidehill", straight_course(parameters.length_m),
                     [](double, double y) { return GroundPoint{kPlainHeight + kTan15 * y}; });
}

WorldData make_crest(const SceneParameters& parameters) {
  const SlopeProfile profile({{kCrestX - kCrestHalf, 0.0},
                              {kCrestX - kCrestHalf + kCrestRounding, kTan14},
                              {kCrestX - kCrestRounding, kTan14},
                              {kCrestX + kCrestRounding, -kTan14},
                              {kCrestX + kCrestHalf - kCrestRounding, -kTan14},
                              {kCrestX + kCrestHalf, 0.0}});
  return paint_world("crest", straight_course(parameters.length_m),
                     [&](double x, double) { return GroundPoint{profile.height_m(x)}; });
}

WorldData make_bumps(const SceneParameters& parameters) {
  Random random(derive(parameters.seed, 0xB0B5));
  std::vector<Bump> bumps;
  for (double x = 8.0; x < parameters.length_m + kAround; x += random.between(6.0, 10.0))
    bumps.push_back({x, random.between(2.0, 3.0), random.between(0.15, 0.25)});
  return paint_world("bumps", straight_course(parameters.length_m), [&](double x, double) {
    double height = kPlainHeight;
    for (const Bump& bump : bumps) height += bump.height_at(x);
    return GroundPoint{height};
  });
}

}  // namespace gvom::sim
