#include "tools/sim/sweep_simulator.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kMaxRange = 100.0;
constexpr double kMinRange = 0.3;
constexpr double kTurn = 6.283185307179586;
constexpr double kDegree = kTurn / 360.0;

// Streams of a ray's key beside those of the world.
constexpr std::uint64_t kRangeStream = 1ULL << 32;
constexpr std::uint64_t kShadeStream = kRangeStream + 1;
constexpr std::uint64_t kLossStream = kRangeStream + 2;

std::vector<Eigen::Vector3d> beam_directions(const LidarModel& lidar) {
  std::vector<Eigen::Vector3d> directions;
  for (int beam = 0; beam < lidar.beams(); ++beam) {
    const double altitude = lidar.altitude_deg[beam] * kDegree;
    const double azimuth = -lidar.azimuth_deg[beam] * kDegree;
    directions.emplace_back(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                            std::sin(altitude));
  }
  return directions;
}

/// The frame that the beams of a column fire in.
Eigen::Isometry3d column_to_sensor(const LidarModel& lidar, int column) {
  const double turned = kTurn * (1.0 - static_cast<double>(column) / lidar.columns);
  return lidar.T_sensor_lidar * Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ());
}

}  // namespace

SweepSimulator::SweepSimulator(const World& world, const Motion& motion, const LidarModel& lidar,
                               const SweepOptions& options)
    : world_(world), motion_(motion), lidar_(lidar), options_(options), directions_(beam_directions(lidar)) {}

/// What a beam reports: the range counts from the lidar's axis, so the way to the beam's origin is in it.
Pixel SweepSimulator::measure_ray(const Ray& ray, const std::vector<Primitive>& walkers,
                                  std::uint64_t key) const {
  const Hit hit = world_.cast(ray, walkers, kMaxRange, key);
  if (hit.range_m > kMaxRange) return {};
  if (uniform(derive(key, kLossStream)) >= chance_of(hit, options_.losses)) return {};
  const double noise_m = options_.range_noise_m * normal(derive(key, kRangeStream));
  const double range_m = hit.range_m + lidar_.beam_origin_m + noise_m;
  if (range_m < kMinRange) return {};
  const std::uint64_t shade = derive(key, kShadeStream);
  return {static_cast<std::uint16_t>(std::lround(range_m / lidar_.range_unit_m)),
          static_cast<std::uint8_t>(hit.reflectivity + shade % 8),
          static_cast<std::uint8_t>(20 + (shade >> 8) % 16)};
}

void SweepSimulator::measure_column(int sweep, int column, Pixel* pixels) const {
  const std::uint64_t lidar_key =
      derive(derive(options_.seed, 0x5EE9), static_cast<std::uint64_t>(lidar_.number));
  const std::uint64_t sweep_key = derive(lidar_key, static_cast<std::uint64_t>(sweep));
  const double time_s = 1e-9 * static_cast<double>(lidar_.stamp_ns(sweep, column) - kStartNs);
  const Pose base = motion_.at(time_s);
  const Eigen::Isometry3d T_odom_beams = Eigen::Translation3d(base.translation_m) * base.rotation *
                                         lidar_.T_base_sensor * column_to_sensor(lidar_, column);
  const std::vector<Primitive> walkers = world_.walkers_at(time_s);
  const Eigen::Vector3d origin = T_odom_beams * Eigen::Vector3d(lidar_.beam_origin_m, 0.0, 0.0);
  for (int beam = 0; beam < lidar_.beams(); ++beam) {
    const std::uint64_t key = derive(sweep_key, static_cast<std::uint64_t>(column * lidar_.beams() + beam));
    pixels[beam] = measure_ray({origin, T_odom_beams.linear() * directions_[beam]}, walkers, key);
  }
}

void SweepSimulator::measure(int sweep, gvom::Sweep& out) const {
  assemble(sweep, measure_ranges(sweep), out);
}

std::vector<std::uint16_t> SweepSimulator::measure_ranges(int sweep) const {
  std::vector<std::uint16_t> range_units;
  range_units.reserve(static_cast<std::size_t>(lidar_.columns) * lidar_.beams());
  std::vector<Pixel> pixels(lidar_.beams());
  for (int column = 0; column < lidar_.columns; ++column) {
    measure_column(sweep, column, pixels.data());
    for (const Pixel& pixel : pixels) range_units.push_back(pixel.range_units);
  }
  return range_units;
}

void SweepSimulator::assemble(int sweep, const std::vector<std::uint16_t>& range_units,
                              gvom::Sweep& out) const {
  out.clear();
  const Eigen::Vector3d origin(lidar_.beam_origin_m, 0.0, 0.0);
  for (int column = 0; column < lidar_.columns; ++column) {
    const std::uint16_t* pixels = range_units.data() + static_cast<std::ptrdiff_t>(column) * lidar_.beams();
    const Eigen::Isometry3d T_sensor_beams = column_to_sensor(lidar_, column);
    out.times_ns.push_back(lidar_.stamp_ns(sweep, column));
    for (int beam = 0; beam < lidar_.beams(); ++beam) {
      if (pixels[beam] == 0) continue;
      const double range_m = pixels[beam] * lidar_.range_unit_m - lidar_.beam_origin_m;
      const Eigen::Vector3d point = T_sensor_beams * (origin + range_m * directions_[beam]);
      out.returns.push_back({point.x(), point.y(), point.z(), static_cast<std::uint32_t>(column)});
      out.stamp_ns = out.times_ns.back();
    }
  }
  if (out.returns.empty()) out.stamp_ns = out.times_ns.back();
}

}  // namespace gvom::sim
