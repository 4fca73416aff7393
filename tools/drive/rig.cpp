#include "tools/drive/rig.hpp"

#include "tools/sim/sweep_simulator.hpp"

namespace gvom::driving {
namespace {

constexpr std::int64_t kTurn_ns = 100'000'000;
constexpr std::int64_t kOutOfStep_ns = 37'100'000;  // between the lidars' turns
constexpr int kSensor_hz = 10;

}  // namespace

std::vector<sim::LidarModel> make_lidars(const Rig& rig, std::uint64_t seed) {
  std::vector<sim::LidarModel> lidars;
  for (const LidarGeometry& geometry : rig.mapping.lidars) {
    const int number = static_cast<int>(lidars.size());
    const sim::LidarPlace place{"lidar", number, 0, sim::kStartNs - number * kOutOfStep_ns % kTurn_ns,
                                geometry.T_base_sensor};
    lidars.push_back(make_lidar(rig.sensor, place, kSensor_hz, seed));
  }
  return lidars;
}

}  // namespace gvom::driving
