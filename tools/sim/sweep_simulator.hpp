// What a lidar measures while the vehicle drives: a sweep at a time, without packets and files.
#pragma once

#include <cstdint>
#include <vector>

#include "core/sweep.hpp"
#include "tools/sim/lidar_model.hpp"
#include "tools/sim/motion.hpp"
#include "tools/sim/sensor_losses.hpp"
#include "tools/sim/world.hpp"

namespace gvom::sim {

/// Stamp of the start of the drive.
inline constexpr std::int64_t kStartNs = 1000'000'000'000;

struct SweepOptions {
  std::uint64_t seed = 1;
  double range_noise_m = 0.02;  ///< Standard deviation.
  SensorLosses losses;
};

/// One measurement; range 0: no return.
struct Pixel {
  std::uint16_t range_units;
  std::uint8_t reflectivity;
  std::uint8_t near_infrared;
};

/// Deterministic, and safe to use from several threads: a sweep depends on nothing but what is given here and
/// its number.
class SweepSimulator {
 public:
  /// World, motion and lidar must outlive it. The motion must be known over what is measured.
  SweepSimulator(const World& world, const Motion& motion, const LidarModel& lidar,
                 const SweepOptions& options);

  /// The sweep as the product decodes it from the sensor's packets: returns in the sensor's frame in metres,
  /// ranges in the packets' units, a time for each column.
  void measure(int sweep, gvom::Sweep& out) const;

  /// The two halves of `measure`: ranges in the packets' units, [column][beam], 0 where nothing came back;
  /// and the sweep of such ranges.
  [[nodiscard]] std::vector<std::uint16_t> measure_ranges(int sweep) const;
  void assemble(int sweep, const std::vector<std::uint16_t>& range_units, gvom::Sweep& out) const;

  /// One column, `lidar.beams()` pixels. Cast from where the lidar is at the column's own stamp.
  void measure_column(int sweep, int column, Pixel* pixels) const;

  [[nodiscard]] const LidarModel& lidar() const { return lidar_; }

 private:
  [[nodiscard]] Pixel measure_ray(const Ray& ray, const std::vector<Primitive>& walkers,
                                  std::uint64_t key) const;

  const World& world_;
  const Motion& motion_;
  const LidarModel& lidar_;
  SweepOptions options_;
  std::vector<Eigen::Vector3d> directions_;  // of the beams in the lidar's frame when it points along +x
};

}  // namespace gvom::sim
