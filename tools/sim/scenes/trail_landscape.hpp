// The shape of the land as formulas: a curving trail through rolling terrain, a ditch across it and a
// step beside it. x runs along the trail from the vehicle's start; metres, odom frame.
#pragma once

#include <cstdint>
#include <vector>

namespace gvom::sim {

inline constexpr double kDitchX = 30.0;
inline constexpr double kDitchWidth = 2.0;
inline constexpr double kDitchDepth = 1.2;
inline constexpr double kStepX = 12.0;
inline constexpr double kStepHeight = 1.5;

/// One plane wave of the relief: amplitude * sin(kx x + ky y + phase).
struct Wave {
  double amplitude_m;
  double kx;
  double ky;
  double phase;
};

/// A place relative to a feature: along the trail's direction there, and to the left of it.
struct TrailFrame {
  double along_m;
  double left_m;
};

class Landscape {
 public:
  explicit Landscape(std::uint64_t seed);

  /// The trail's centre line y(x) and its derivative.
  [[nodiscard]] double trail_y_m(double x_m) const;
  [[nodiscard]] double trail_slope(double x_m) const;

  /// The rolling terrain alone, which the vehicle follows: no ditch, no step, no ripples.
  [[nodiscard]] double relief_m(double x_m, double y_m) const;
  /// How much of the waves is left `lateral_m` from the trail's centre line: it is gentler there.
  [[nodiscard]] static double trail_factor(double lateral_m);
  /// Depth below and height above the relief, 0 where there is no ditch or step.
  [[nodiscard]] double ditch_depth_m(double x_m, double y_m) const;
  [[nodiscard]] double step_height_m(double x_m, double y_m) const;
  /// True on the steep sides of the step.
  [[nodiscard]] bool on_step_face(double x_m, double y_m) const;

  /// (x, y) seen from the trail's point at `station_x_m`.
  [[nodiscard]] TrailFrame relative_to(double station_x_m, double x_m, double y_m) const;

  [[nodiscard]] const std::vector<Wave>& waves() const { return waves_; }
  /// Short and low waves of the ground itself, on the trail too; the vehicle does not follow them.
  [[nodiscard]] const std::vector<Wave>& ripples() const { return ripples_; }

 private:
  std::vector<Wave> waves_;
  std::vector<Wave> ripples_;
  double bend_phase_[2];
};

}  // namespace gvom::sim
