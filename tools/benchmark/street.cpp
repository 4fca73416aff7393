#include <cmath>
#include <limits>

#include "tools/benchmark/recording.hpp"

namespace gvom::bench {

namespace {

constexpr int kSweeps = 11;
constexpr double kSensorHeight_m = 1.73;
constexpr double kPeriod_m = 12.8;  // of the street, and one lap: four bricks of 0.4 m voxels
constexpr double kBump_m = 0.3;     // up and down once in a lap: through the face between two bricks
constexpr double kPi = 3.14159265358979323846;

std::vector<Box> street_boxes() {
  std::vector<Box> boxes{{{-200, -200, -1}, {200, 200, 0}}};  // the ground
  for (int i = -10; i < 10; ++i) {
    const double x = kPeriod_m * i;
    boxes.push_back({{x, 9, 0}, {x + 10, 19, 7}});  // houses, with alleys between them
    boxes.push_back({{x + 5, -21, 0}, {x + 14, -11, 9}});
    boxes.push_back({{x + 1, 5, 0.3}, {x + 5.2, 6.8, 1.5}});  // cars
    boxes.push_back({{x + 7, -7.5, 0.3}, {x + 11, -5.8, 1.6}});
    boxes.push_back({{x + 6, 7.5, 0}, {x + 6.2, 7.7, 6}});  // poles
  }
  return boxes;
}

// Where the ray enters the box, in lengths of `along`; infinity if it does not.
double distance_to(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double enter = 0;
  double leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double one = (box.min_m[a] - from[a]) / along[a];
    const double other = (box.max_m[a] - from[a]) / along[a];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

Sweep sweep_from(const Eigen::Vector3d& sensor_m, const StreetLidar& lidar, const std::vector<Box>& boxes) {
  Sweep sweep;
  sweep.times_ns = {0};
  for (int azimuth = 0; azimuth < lidar.azimuths; ++azimuth)
    for (int beam = 0; beam < lidar.beams; ++beam) {
      const double turn_rad = 2 * kPi * (azimuth + 0.5) / lidar.azimuths;
      const double lift_rad =
          lidar.lowest_rad + (lidar.highest_rad - lidar.lowest_rad) * beam / (lidar.beams - 1);
      const Eigen::Vector3d along(std::cos(turn_rad) * std::cos(lift_rad),
                                  std::sin(turn_rad) * std::cos(lift_rad), std::sin(lift_rad));
      double range_m = std::numeric_limits<double>::infinity();
      for (const Box& box : boxes) range_m = std::min(range_m, distance_to(box, sensor_m, along));
      if (range_m > 120) continue;
      const Eigen::Vector3d p = range_m * along;
      sweep.returns.push_back({p.x(), p.y(), p.z(), 0});
    }
  return sweep;
}

}  // namespace

Recording make_street(const StreetLidar& lidar) {
  Recording recording;
  recording.name = std::string("a synthetic street, ") + lidar.name;
  recording.lidar.T_base_sensor.translation().z() = kSensorHeight_m;
  recording.lap_m.x() = kPeriod_m;
  const std::vector<Box> boxes = street_boxes();
  for (int i = 0; i < kSweeps; ++i) {
    Pose pose;
    const double share = static_cast<double>(i) / kSweeps;
    pose.translation_m = {kPeriod_m * share, 0.1, kBump_m * std::sin(2 * kPi * share)};
    const Eigen::Vector3d sensor_m = pose.translation_m + Eigen::Vector3d(0, 0, kSensorHeight_m);
    recording.sweeps.push_back(sweep_from(sensor_m, lidar, boxes));
    recording.T_odom_base.push_back(pose);
  }
  return recording;
}

}  // namespace gvom::bench
