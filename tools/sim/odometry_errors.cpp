#include "tools/sim/odometry_errors.hpp"

#include <cmath>

namespace gvom::sim {
namespace {

constexpr double kMemory_s = 1.0;

/// What is left of an error after the time from one pose to the next.
double kept_part(int rate_hz) {
  const std::int64_t period_ns = 1'000'000'000 / rate_hz;
  return std::exp(-1e-9 * static_cast<double>(period_ns) / kMemory_s);
}

}  // namespace

OdometryErrors::OdometryErrors(const OdometryNoise& noise, int rate_hz, std::uint64_t seed)
    : noise_(noise),
      kept_(kept_part(rate_hz)),
      fresh_(std::sqrt(1.0 - kept_ * kept_)),
      random_(derive(seed, 0x0D0)),
      shift_(draw()),
      turn_(draw()) {}

Eigen::Vector3d OdometryErrors::draw() {
  const double x = random_.normal(), y = random_.normal(), z = random_.normal();
  return {x, y, z};
}

Pose OdometryErrors::disturb(const Pose& T_odom_base) {
  Pose pose = T_odom_base;
  pose.translation_m += noise_.position_m * shift_;
  const Eigen::Vector3d half = 0.5 * noise_.rotation_rad * turn_;  // small angles
  const Eigen::Quaterniond wobble = Eigen::Quaterniond(1.0, half.x(), half.y(), half.z()).normalized();
  pose.rotation = (pose.rotation * wobble).normalized();
  shift_ = kept_ * shift_ + fresh_ * draw();
  turn_ = kept_ * turn_ + fresh_ * draw();
  return pose;
}

}  // namespace gvom::sim
