// Edges: banks, a cliff and potholes.
#include <algorithm>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/scenes.hpp"

namespace gvom::sim {
namespace {

constexpr double kBankHeight = 1.5;
constexpr double kBankRun = 0.7;  // 65 degrees
constexpr double kBelowBank = 2.0;
constexpr double kCliffHeight = 5.0;
constexpr double kCliffRun = 0.2;
constexpr double kBelowCliff = 3.0;
constexpr double kShallowPothole = 0.45;  // on the path but for one
constexpr double kDeepPothole = 0.6;
constexpr double kDeepPotholeX = 40.0;

/// Ground that goes on `drop_m` lower behind a face from `kEnd` on; a hole to `below_m` behind the edge.
struct Drop {
  double drop_m;
  double run_m;
  double below_m;

  [[nodiscard]] GroundPoint at(double x) const {
    const double fallen = std::clamp((x - kEnd) / run_m, 0.0, 1.0);
    GroundPoint point{kPlainHeight - fallen * drop_m};
    if (fallen > 0.0 && fallen < 1.0) point.surface = Surface::face;
    if (fallen == 1.0 && x < kEnd + below_m) point.surface = Surface::hole;
    return point;
  }
};

WorldData make_drop(const char* name, const Drop& drop) {
  return paint_world(name, straight_course(kEndingPath), [&](double x, double) { return drop.at(x); });
}

}  // namespace

WorldData make_bank_down(const SceneParameters&) {
  return make_drop("bank-down", {kBankHeight, kBankRun, kBelowBank});
}

WorldData make_bank_up(const SceneParameters&) {
  return make_drop("bank-up", {-kBankHeight, kBankRun, 0.0});
}

WorldData make_cliff(const SceneParameters&) {
  return make_drop("cliff", {kCliffHeight, kCliffRun, kBelowCliff});
}

WorldData make_potholes(const SceneParameters& parameters) {
  Random random(derive(parameters.seed, 0x907));
  std::vector<Pothole> potholes;
  for (double x = 8.0; x < parameters.length_m + 30.0; x += 4.0) {
    const bool on_path = potholes.size() % 2 == 0;
    const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const double y = on_path ? random.between(-0.8, 0.8) : side * random.between(2.0, 6.0);
    const double deepest = on_path ? kShallowPothole : kDeepPothole;
    potholes.push_back(
        {{x + random.between(-1.0, 1.0), y}, random.between(0.4, 0.6), random.between(0.3, deepest)});
    if (x == kDeepPotholeX) potholes.back() = {{x, 0.0}, 0.6, kDeepPothole};
  }
  return paint_world("potholes", straight_course(parameters.length_m), [&](double x, double y) {
    double depth = 0.0;
    for (const Pothole& pothole : potholes) depth = std::max(depth, pothole.depth_at(x, y));
    return dug(kPlainHeight, depth);
  });
}

}  // namespace gvom::sim
