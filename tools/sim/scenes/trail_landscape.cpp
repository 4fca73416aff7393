#include "tools/sim/scenes/trail_landscape.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kBendAmplitude[2] = {2.5, 0.8};
constexpr double kBendNumber[2] = {kTurn / 75.0, kTurn / 33.0};

constexpr int kWaves = 8;
constexpr double kShortestWave = 8.0;
constexpr double kLongestWave = 40.0;
constexpr double kAmplitudePerLength = 0.0055;  // about 0.5 m where the waves meet
constexpr int kRipples = 3;
constexpr double kRippleAmplitude = 0.01;

constexpr double kDitchSide = 0.4;  // horizontal run of each side
constexpr double kDitchReach = 14.0;
constexpr double kStepHalfLength = 5.0;
constexpr double kStepLeft = 5.0;  // from the trail's centre line to the face
constexpr double kStepRight = 17.0;
constexpr double kStepFace = 0.15;  // horizontal run of the steep sides
constexpr double kStepBack = 6.0;   // horizontal run of the far side

double ramp(double value) {
  return std::clamp(value, 0.0, 1.0);
}

Wave make_wave(Random& random, double length_m, double amplitude_m) {
  const double direction = random.between(0.0, kTurn);
  const double number = kTurn / length_m;
  return {amplitude_m, number * std::cos(direction), number * std::sin(direction),
          random.between(0.0, kTurn)};
}

}  // namespace

Landscape::Landscape(std::uint64_t seed) {
  Random random(derive(seed, 0x1A4D));
  for (double& phase : bend_phase_) phase = random.between(0.0, kTurn);
  for (int i = 0; i < kWaves; ++i) {
    const double length = kShortestWave * std::pow(kLongestWave / kShortestWave, i / (kWaves - 1.0));
    waves_.push_back(make_wave(random, length, kAmplitudePerLength * length));
  }
  for (int i = 0; i < kRipples; ++i)
    ripples_.push_back(make_wave(random, random.between(1.2, 3.0), kRippleAmplitude));
}

double Landscape::trail_y_m(double x_m) const {
  double y = 0.0;
  for (int i = 0; i < 2; ++i) y += kBendAmplitude[i] * std::sin(kBendNumber[i] * x_m + bend_phase_[i]);
  return y;
}

double Landscape::trail_slope(double x_m) const {
  double slope = 0.0;
  for (int i = 0; i < 2; ++i)
    slope += kBendAmplitude[i] * kBendNumber[i] * std::cos(kBendNumber[i] * x_m + bend_phase_[i]);
  return slope;
}

double Landscape::trail_factor(double lateral_m) {
  const double away = ramp((std::abs(lateral_m) - 1.5) / 6.0);
  return 0.35 + 0.65 * away * away * (3.0 - 2.0 * away);
}

double Landscape::relief_m(double x_m, double y_m) const {
  double sum = 0.0;
  for (const Wave& wave : waves_)
    sum += wave.amplitude_m * std::sin(wave.kx * x_m + wave.ky * y_m + wave.phase);
  return sum * trail_factor(y_m - trail_y_m(x_m));
}

TrailFrame Landscape::relative_to(double station_x_m, double x_m, double y_m) const {
  const double slope = trail_slope(station_x_m);
  const double norm = 1.0 / std::sqrt(1.0 + slope * slope);
  const double dx = x_m - station_x_m;
  const double dy = y_m - trail_y_m(station_x_m);
  return {(dx + slope * dy) * norm, (dy - slope * dx) * norm};
}

double Landscape::ditch_depth_m(double x_m, double y_m) const {
  if (std::abs(x_m - kDitchX) > kDitchReach) return 0.0;
  const TrailFrame at = relative_to(kDitchX, x_m, y_m);
  const double across = ramp((kDitchWidth / 2.0 - std::abs(at.along_m)) / kDitchSide);
  return kDitchDepth * across * ramp((kDitchReach - std::abs(at.left_m)) / 2.0);
}

double Landscape::step_height_m(double x_m, double y_m) const {
  if (std::abs(x_m - kStepX) > kStepRight) return 0.0;
  const TrailFrame at = relative_to(kStepX, x_m, y_m);
  return kStepHeight * ramp((at.left_m - kStepLeft) / kStepFace) *
         ramp((kStepRight - at.left_m) / kStepBack) *
         ramp((kStepHalfLength - std::abs(at.along_m)) / kStepFace);
}

bool Landscape::on_step_face(double x_m, double y_m) const {
  constexpr double kReach = 0.05;
  constexpr double kRise = 0.15;
  return std::abs(step_height_m(x_m + kReach, y_m) - step_height_m(x_m - kReach, y_m)) > kRise ||
         std::abs(step_height_m(x_m, y_m + kReach) - step_height_m(x_m, y_m - kReach)) > kRise;
}

}  // namespace gvom::sim
