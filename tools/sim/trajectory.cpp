#include "tools/sim/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gvom::sim {
namespace {

constexpr double kStep = 0.05;      // metres between two stations
constexpr double kExact = 1e-9;     // metres: less is rounding
constexpr int kRunUpSteps = 120;    // of them before the start and after the end
constexpr int kRounding = 40;       // steps to both sides that are averaged, twice, to round corners off
constexpr int kHalfBase = 12;       // wheels: steps before and behind base_link,
constexpr double kHalfTrack = 0.5;  // and metres beside it
constexpr double kHalfPatch = 0.2;  // of the ground that a wheel stands on
constexpr int kPatchSamples = 5;    // along each of its edges
constexpr std::int64_t kMargin = 50'000'000;

using Points = std::vector<Eigen::Vector2d>;

/// Without corners that lie on the one before.
Points distinct(const Points& corners) {
  Points out;
  for (const Eigen::Vector2d& corner : corners)
    if (out.empty() || (corner - out.back()).norm() > kExact) out.push_back(corner);
  return out;
}

/// Points at equal steps along a polyline, from its first point on, the first and last piece prolonged by
/// `more_steps`.
Points resample(const Points& corners, int more_steps) {
  const Eigen::Vector2d first = (corners[1] - corners[0]).normalized();
  Points out;
  for (int i = more_steps; i > 0; --i) out.push_back(corners[0] - i * kStep * first);
  double into = 0.0;  // the next point's way into the piece
  Eigen::Vector2d along = first;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const double length = (corners[i + 1] - corners[i]).norm();
    along = (corners[i + 1] - corners[i]) / length;
    for (; into <= length + kExact; into += kStep) out.push_back(corners[i] + into * along);
    into -= length;
  }
  for (int i = 0; i < more_steps; ++i) out.push_back(out.back() + kStep * along);
  return out;
}

/// The mean of each point and its `kRounding` neighbours to both sides; as many points less at both ends.
Points rounded(const Points& points) {
  Points out;
  for (std::size_t i = kRounding; i + kRounding < points.size(); ++i) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t k = i - kRounding; k <= i + kRounding; ++k) sum += points[k];
    out.emplace_back(sum / (2.0 * kRounding + 1.0));
  }
  return out;
}

/// The mean height of the ground under a wheel; nothing over a hole or a face.
std::optional<double> wheel_height(const Terrain& terrain, const Eigen::Vector2d& wheel) {
  double sum = 0.0;
  for (int i = 0; i < kPatchSamples * kPatchSamples; ++i) {
    const auto offset = [](int k) { return kHalfPatch * (2.0 * k / (kPatchSamples - 1.0) - 1.0); };
    const double x = wheel.x() + offset(i % kPatchSamples), y = wheel.y() + offset(i / kPatchSamples);
    if (!terrain.is_sound(x, y)) return std::nullopt;
    sum += terrain.height_m(x, y);
  }
  return sum / (kPatchSamples * kPatchSamples);
}

/// Gaps filled straight from the height before to the one after, or level where one side has none.
std::vector<double> bridged(const std::vector<std::optional<double>>& heights) {
  std::vector<double> out(heights.size(), 0.0);
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!heights[i]) continue;
    const std::size_t from = before ? *before : 0;
    const double low = before ? *heights[*before] : *heights[i];
    for (std::size_t k = from; k < i; ++k)
      out[k] = low + (*heights[i] - low) * static_cast<double>(k - from) / static_cast<double>(i - from);
    out[i] = *heights[i];
    before = i;
  }
  if (before) std::fill(out.begin() + static_cast<std::ptrdiff_t>(*before), out.end(), *heights[*before]);
  return out;
}

}  // namespace

Trajectory::Trajectory(const Terrain& terrain, const std::vector<Eigen::Vector2d>& path_m, const Drive& drive)
    : drive_(drive) {
  // Once more by equal steps, for rounding cuts corners short. Each rounding takes points away at both ends.
  const Points driven = resample(distinct(path_m), 2 * kRounding + 1);
  const Points way = resample(rounded(rounded(driven)), kRunUpSteps);
  length_m_ = static_cast<double>(way.size() - 2 * (kRunUpSteps + 1) - 1) * kStep;
  for (std::size_t i = 1; i + 1 < way.size(); ++i)
    stations_.push_back({way[i], (way[i + 1] - way[i - 1]).normalized(), 0.0, 0.0, 0.0});
  lean_on(terrain);
}

/// Puts the wheels on the ground, at every station.
void Trajectory::lean_on(const Terrain& terrain) {
  std::vector<std::optional<double>> left, right;
  for (const Station& station : stations_) {
    const Eigen::Vector2d aside = kHalfTrack * Eigen::Vector2d(-station.forward.y(), station.forward.x());
    left.push_back(wheel_height(terrain, station.middle_m + aside));
    right.push_back(wheel_height(terrain, station.middle_m - aside));
  }
  const std::vector<double> left_m = bridged(left), right_m = bridged(right);
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const std::size_t rear = i - std::min<std::size_t>(i, kHalfBase);
    const std::size_t front = std::min(i + kHalfBase, stations_.size() - 1);
    const double ahead = left_m[front] + right_m[front], behind = left_m[rear] + right_m[rear];
    const double to_left = left_m[front] + left_m[rear], to_right = right_m[front] + right_m[rear];
    stations_[i].ground_m = 0.25 * (ahead + behind);
    stations_[i].pitch_rad = -std::atan((ahead - behind) / (4.0 * kHalfBase * kStep));
    stations_[i].roll_rad = std::atan((to_left - to_right) / (4.0 * kHalfTrack));
  }
}

Pose Trajectory::at(double time_s) const {
  const double place = std::clamp(drive_.speed_mps * time_s / kStep + kRunUpSteps, 0.0,
                                  static_cast<double>(stations_.size()) - 1.001);
  const auto index = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(index);
  const Station& from = stations_[index];
  const Station& to = stations_[index + 1];
  const auto mix_of = [part](const auto& a, const auto& b) { return ((1.0 - part) * a + part * b).eval(); };
  const Eigen::Vector2d middle = mix_of(from.middle_m, to.middle_m);
  const Eigen::Vector2d forward = mix_of(from.forward, to.forward);
  const Eigen::Vector3d lean = mix_of(Eigen::Vector3d(from.ground_m, from.pitch_rad, from.roll_rad),
                                      Eigen::Vector3d(to.ground_m, to.pitch_rad, to.roll_rad));
  Pose pose;
  pose.translation_m = {middle.x(), middle.y(), lean[0] + drive_.base_height_m};
  pose.rotation = Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(lean[1], Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(lean[2], Eigen::Vector3d::UnitX());
  return pose;
}

std::vector<StampedPose> make_odometry(const Motion& motion, const OdometrySpan& span,
                                       const OdometryNoise& noise, std::uint64_t seed) {
  const std::int64_t period = 1'000'000'000 / span.rate_hz;
  OdometryErrors errors(noise, span.rate_hz, seed);
  std::vector<StampedPose> poses;
  // Stamps are whole periods, so that they are short decimals.
  const std::int64_t first = (span.begin_ns - kMargin) / period * period;
  for (std::int64_t stamp = first; stamp < span.end_ns + kMargin + period; stamp += period)
    poses.push_back({stamp, errors.disturb(motion.at(1e-9 * static_cast<double>(stamp - span.start_ns)))});
  return poses;
}

}  // namespace gvom::sim
