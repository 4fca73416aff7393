#include "tools/sim/scenes/ground.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr int kHills = 5;
constexpr int kRipples = 5;
constexpr double kDitchSide = 0.1;    // run of each side
constexpr double kDitchEnd = 0.5;     // run of its ends
constexpr double kPotholeSide = 0.2;  // run of the side, inside the radius
constexpr double kLobe = 0.7;         // of a patch's radius: where its lobes are and how large

double ramp(double value) {
  return std::clamp(value, 0.0, 1.0);
}

}  // namespace

WorldData paint_world(const std::string& name, const Course& course, const GroundFormula& formula,
                      double resolution_m) {
  Eigen::Vector2d low = course.path_m.front(), high = low;
  for (const Eigen::Vector2d& corner : course.path_m) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  WorldData world;
  world.name = name;
  world.path_m = course.path_m;
  GroundMap& ground = world.ground;
  ground.resolution_m = resolution_m;
  ground.min_x_m = std::floor(low.x() - kAround);
  ground.min_y_m = std::floor(low.y() - kAround);
  ground.nodes_x = static_cast<int>(std::ceil((high.x() + kAround - ground.min_x_m) / resolution_m)) + 1;
  ground.nodes_y = static_cast<int>(std::ceil((high.y() + kAround - ground.min_y_m) / resolution_m)) + 1;
  const std::size_t count = static_cast<std::size_t>(ground.nodes_x) * ground.nodes_y;
  ground.height_m.reserve(count);
  ground.surface.reserve(count);
  for (int iy = 0; iy < ground.nodes_y; ++iy)
    for (int ix = 0; ix < ground.nodes_x; ++ix) {
      const GroundPoint point =
          formula(ground.min_x_m + ix * resolution_m, ground.min_y_m + iy * resolution_m);
      ground.height_m.push_back(static_cast<float>(quantised(point.height_m)));
      ground.surface.push_back(point.surface);
    }
  return world;
}

double height_at(const GroundMap& ground, double x_m, double y_m) {
  const double cell_x = std::clamp((x_m - ground.min_x_m) / ground.resolution_m, 0.0, ground.nodes_x - 1.0);
  const double cell_y = std::clamp((y_m - ground.min_y_m) / ground.resolution_m, 0.0, ground.nodes_y - 1.0);
  const int ix = std::min(static_cast<int>(cell_x), ground.nodes_x - 2);
  const int iy = std::min(static_cast<int>(cell_y), ground.nodes_y - 2);
  const float* low = ground.height_m.data() + static_cast<std::size_t>(iy) * ground.nodes_x + ix;
  const float* high = low + ground.nodes_x;
  const double right = cell_x - ix;
  const double near_side = low[0] + right * (low[1] - low[0]);
  const double far_side = high[0] + right * (high[1] - high[0]);
  return near_side + (cell_y - iy) * (far_side - near_side);
}

GroundPoint dug(double ground_m, double depth_m) {
  return {ground_m - depth_m, depth_m >= kHoleDepth ? Surface::hole : Surface::ground};
}

Relief::Relief(std::uint64_t seed, const Course& course, const ReliefShape& shape) {
  Random random(derive(seed, 0x4E11EF));
  // Each wave has its own sector of directions, so that they never look like one.
  const auto add_wave = [&](int number_of, int count, double length_m, double amplitude_m) {
    const double direction = kTurn / count * (number_of + random.between(0.0, 1.0));
    const double number = kTurn / length_m;
    waves_.push_back({amplitude_m,
                      {number * std::cos(direction), number * std::sin(direction)},
                      random.between(0.0, kTurn)});
  };
  for (int i = 0; i < kHills; ++i) {
    const double length = shape.shortest_m * std::pow(shape.longest_m / shape.shortest_m, i / (kHills - 1.0));
    add_wave(2 * i % kHills, kHills, length, length);
  }
  const double scale = shape.steepest / steepest(course.path_m.back().x() + kAround);
  for (Wave& wave : waves_) wave.amplitude_m *= scale;
  for (int i = 0; i < kRipples; ++i)
    add_wave(i, kRipples, random.between(2.0, 5.0), shape.ripple_m / kRipples);
}

double Relief::height_m(double x_m, double y_m) const {
  double sum = kPlainHeight;
  for (const Wave& wave : waves_)
    sum +=
        wave.amplitude_m * std::sin(wave.number_per_m.x() * x_m + wave.number_per_m.y() * y_m + wave.phase);
  return sum;
}

double Relief::steepest(double end_x_m) const {
  double steepest = 0.0;
  for (double y = -kAround; y <= kAround; y += 1.0)
    for (double x = -kAround; x <= end_x_m; x += 1.0) {
      Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
      for (const Wave& wave : waves_)
        gradient += wave.amplitude_m *
                    std::cos(wave.number_per_m.x() * x + wave.number_per_m.y() * y + wave.phase) *
                    wave.number_per_m;
      steepest = std::max(steepest, gradient.norm());
    }
  return steepest;
}

double SlopeProfile::height_m(double x_m) const {
  double height = kPlainHeight;
  if (x_m <= corners_.front().x_m) return height + (x_m - corners_.front().x_m) * corners_.front().slope;
  for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
    const Corner& from = corners_[i];
    const Corner& to = corners_[i + 1];
    const double run = std::min(x_m, to.x_m) - from.x_m;
    const double bend = (to.slope - from.slope) / (to.x_m - from.x_m);
    height += run * (from.slope + 0.5 * bend * run);
    if (x_m <= to.x_m) return height;
  }
  return height + (x_m - corners_.back().x_m) * corners_.back().slope;
}

double Ditch::depth_at(double x_m, double y_m) const {
  const Eigen::Vector2d across(std::cos(turned_rad), std::sin(turned_rad));
  const Eigen::Vector2d from_middle = Eigen::Vector2d(x_m, y_m) - middle_m;
  const double beside = std::abs(from_middle.dot(across));
  const double along = std::abs(from_middle.dot(Eigen::Vector2d(-across.y(), across.x())));
  return depth_m * ramp((0.5 * width_m - beside) / kDitchSide + 0.5) *
         ramp((half_length_m - along) / kDitchEnd + 0.5);
}

double Pothole::depth_at(double x_m, double y_m) const {
  return depth_m * ramp((radius_m - (Eigen::Vector2d(x_m, y_m) - middle_m).norm()) / kPotholeSide);
}

bool Patch::covers(double x_m, double y_m) const {
  const Eigen::Vector2d from_middle = Eigen::Vector2d(x_m, y_m) - middle_m;
  const Eigen::Vector2d long_axis(std::cos(turned_rad), std::sin(turned_rad));
  const Eigen::Vector2d short_axis(-long_axis.y(), long_axis.x());
  const double lobe = kLobe * radius_m;
  const auto covered_by_lobe = [&](double along, double beside) {
    return (from_middle - lobe * (along * long_axis + beside * short_axis)).norm() <= lobe;
  };
  return from_middle.norm() <= radius_m || covered_by_lobe(1.0, 0.4) || covered_by_lobe(-1.0, -0.5);
}

}  // namespace gvom::sim
