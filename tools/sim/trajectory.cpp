#include "tools/sim/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kStep = 0.05;      // metres of trail between two points of the table
constexpr int kRunUpSteps = 100;    // of the table before the start and after the end
constexpr double kHalfBase = 0.6;   // wheels: metres before and behind base_link,
constexpr double kHalfTrack = 0.5;  // and beside it
constexpr std::int64_t kMargin = 50'000'000;
constexpr double kNoiseMemory = 1.0;  // seconds

}  // namespace

Trajectory::Trajectory(const Landscape& landscape, double speed_mps, double length_m, double base_height_m)
    : landscape_(landscape), speed_mps_(speed_mps), base_height_m_(base_height_m) {
  const auto advance = [&](double x, double step) {  // midpoint rule
    const auto rate = [&](double at) {
      return 1.0 / std::sqrt(1.0 + std::pow(landscape.trail_slope(at), 2));
    };
    return x + step * rate(x + 0.5 * step * rate(x));
  };
  double x = 0.0;
  for (int i = 0; i < kRunUpSteps; ++i) x = advance(x, -kStep);
  const int points = static_cast<int>(length_m / kStep) + 2 * kRunUpSteps + 2;
  for (int i = 0; i < points; ++i, x = advance(x, kStep)) x_m_.push_back(x);
}

double Trajectory::x_after(double driven_m) const {
  const double at = std::clamp(driven_m / kStep + kRunUpSteps, 0.0, static_cast<double>(x_m_.size() - 2));
  const auto before = static_cast<std::size_t>(at);
  return x_m_[before] + (at - static_cast<double>(before)) * (x_m_[before + 1] - x_m_[before]);
}

Pose Trajectory::at(double time_s) const {
  const double x = x_after(speed_mps_ * time_s);
  const double y = landscape_.trail_y_m(x);
  const double heading = std::atan(landscape_.trail_slope(x));
  const Eigen::Vector2d forward(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const auto wheel = [&](double along, double beside) {
    const Eigen::Vector2d at = Eigen::Vector2d(x, y) + along * forward + beside * left;
    return landscape_.relief_m(at.x(), at.y());
  };
  const double front_left = wheel(kHalfBase, kHalfTrack), front_right = wheel(kHalfBase, -kHalfTrack);
  const double rear_left = wheel(-kHalfBase, kHalfTrack), rear_right = wheel(-kHalfBase, -kHalfTrack);
  const double pitch = -std::atan((front_left + front_right - rear_left - rear_right) / (4.0 * kHalfBase));
  const double roll = std::atan((front_left + rear_left - front_right - rear_right) / (4.0 * kHalfTrack));

  Pose pose;
  pose.translation_m = {x, y, 0.25 * (front_left + front_right + rear_left + rear_right) + base_height_m_};
  pose.rotation = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  return pose;
}

std::vector<StampedPose> make_odometry(const Trajectory& trajectory, const OdometrySpan& span,
                                       const OdometryNoise& noise, std::uint64_t seed) {
  const std::int64_t period = 1'000'000'000 / span.rate_hz;
  const double kept = std::exp(-1e-9 * static_cast<double>(period) / kNoiseMemory);
  const double fresh = std::sqrt(1.0 - kept * kept);
  Random random(derive(seed, 0x0D0));
  const auto draw = [&] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Eigen::Vector3d(x, y, z);
  };
  Eigen::Vector3d shift = draw();
  Eigen::Vector3d turn = draw();
  std::vector<StampedPose> poses;
  // Stamps are whole periods, so that they are short decimals.
  const std::int64_t first = (span.begin_ns - kMargin) / period * period;
  for (std::int64_t stamp = first; stamp < span.end_ns + kMargin + period; stamp += period) {
    StampedPose pose{stamp, trajectory.at(1e-9 * static_cast<double>(stamp - span.start_ns))};
    pose.T_odom_base.translation_m += noise.position_m * shift;
    const Eigen::Vector3d half = 0.5 * noise.rotation_rad * turn;  // small angles
    const Eigen::Quaterniond wobble = Eigen::Quaterniond(1.0, half.x(), half.y(), half.z()).normalized();
    pose.T_odom_base.rotation = (pose.T_odom_base.rotation * wobble).normalized();
    poses.push_back(pose);
    shift = kept * shift + fresh * draw();
    turn = kept * turn + fresh * draw();
  }
  return poses;
}

}  // namespace gvom::sim
