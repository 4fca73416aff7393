#include "services/ingest/ground_check.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::ingest {

namespace {

constexpr std::int64_t kPeriod_ns = 500'000'000;
constexpr std::int64_t kOldest_ns = 60'000'000'000;  // ground that was found before says nothing of now
constexpr std::size_t kFewest = 3;
constexpr double kTravelled_m = 8;
constexpr std::size_t kFewestOnTheWay = 8;

struct Limits {
  double height_m, tilt_rad;
};
constexpr Limits kStanding{0.5, 0.2};
constexpr Limits kOnTheWay{0.2, 0.07};

double tilt_rad(const ipc::Ground& ground) {
  return std::atan(std::hypot(double{ground.slope_x}, double{ground.slope_y}));
}

}  // namespace

GroundCheck::GroundCheck(const LidarGeometry& lidar, const VehicleGeometry& vehicle)
    : lidar_(lidar), vehicle_(vehicle) {
  ground_.verdict = static_cast<std::uint32_t>(ipc::GroundVerdict::not_judged);
}

void GroundCheck::see(const Sweep& sweep, const Eigen::Vector3d& base_position_m) {
  if (has_looked_ && sweep.stamp_ns < looked_ns_) count_ = 0;  // a recording that begins anew
  if (count_ >= kFewest && sweep.stamp_ns - looked_ns_ < kPeriod_ns) return;
  has_looked_ = true;
  looked_ns_ = sweep.stamp_ns;
  forget_old(sweep.stamp_ns);
  if (const auto plane = find_ground(sweep, lidar_, vehicle_)) {
    if (count_ == kLooks) std::copy(looks_.begin() + 1, looks_.end(), looks_.begin());
    count_ = std::min(count_ + 1, kLooks);
    looks_[count_ - 1] = {*plane, sweep.stamp_ns, base_position_m};
  }
  judge();
}

void GroundCheck::forget_old(std::int64_t stamp_ns) {
  const auto end = looks_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto first = std::find_if(looks_.begin(), end,
                                  [&](const Look& look) { return stamp_ns - look.stamp_ns <= kOldest_ns; });
  count_ = static_cast<std::size_t>(std::copy(first, end, looks_.begin()) - looks_.begin());
}

void GroundCheck::judge() {
  ground_ = {};
  ground_.verdict = static_cast<std::uint32_t>(ipc::GroundVerdict::not_judged);
  ground_.expected_z_m = static_cast<float>(-vehicle_.base_height_m);
  is_high_ = is_tilted_ = false;
  if (count_ == 0) return;
  ground_.sweeps = static_cast<std::uint32_t>(count_);
  ground_.height_m = median(&GroundPlane::height_m) + static_cast<float>(vehicle_.base_height_m);
  ground_.slope_x = median(&GroundPlane::slope_x);
  ground_.slope_y = median(&GroundPlane::slope_y);
  if (count_ < kFewest) return;
  const double travelled_m = (looks_[count_ - 1].base_position_m - looks_[0].base_position_m).norm();
  const bool on_the_way = count_ >= kFewestOnTheWay && travelled_m >= kTravelled_m;
  ground_.on_the_way = on_the_way ? 1 : 0;
  const Limits limits = on_the_way ? kOnTheWay : kStanding;
  is_high_ = std::abs(double{ground_.height_m}) > limits.height_m;
  is_tilted_ = tilt_rad(ground_) > limits.tilt_rad;
  const auto verdict = is_wrong() ? ipc::GroundVerdict::wrong : ipc::GroundVerdict::well;
  ground_.verdict = static_cast<std::uint32_t>(verdict);
}

float GroundCheck::median(double GroundPlane::*value) const {
  std::array<double, kLooks> values{};
  for (std::size_t i = 0; i < count_; ++i) values[i] = looks_[i].plane.*value;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count_));
  return static_cast<float>(*middle);
}

bool GroundCheck::is_wrong() const {
  return is_high_ || is_tilted_;
}

void GroundCheck::describe(services::Words& words) const {
  if (is_high_)
    words.add("the ground is %.1f m %s where T_base_sensor and vehicle.base_height_m put it",
              std::abs(double{ground_.height_m}), ground_.height_m > 0 ? "above" : "below");
  if (!is_tilted_) return;
  // As T_base_sensor's own angles, which turn about axes that its yaw has turned.
  const Eigen::Matrix3d R = lidar_.T_base_sensor.linear();
  const double yaw = std::atan2(R(1, 0), R(0, 0)), c = std::cos(yaw), s = std::sin(yaw);
  const double ahead = c * ground_.slope_x + s * ground_.slope_y;
  const double aside = c * ground_.slope_y - s * ground_.slope_x;
  words.add("the ground is tilted by %.0f degrees (pitch %.2f, roll %.2f): is T_base_sensor right?",
            tilt_rad(ground_) * 180 / M_PI, std::atan(-ahead), std::atan(aside));
}

}  // namespace gvom::ingest
