#include "tools/sim/simulate.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "tools/sim/ground_truth.hpp"

namespace gvom::sim {
namespace {

constexpr int kFirstPort = 7502;
constexpr std::int64_t kOutOfStep = 37'100'000;  // nanoseconds between the lidars' first columns

int port_of(const services::LidarConfig& lidar, int number) {
  const std::string scheme = "ouster-udp:";
  if (lidar.source.compare(0, scheme.size(), scheme) != 0) return kFirstPort + number;
  const int port = std::atoi(lidar.source.c_str() + scheme.size());
  return port > 0 && port < 65536 ? port : kFirstPort + number;
}

}  // namespace

std::vector<LidarModel> make_lidars(const services::VehicleConfig& vehicle, const RecordingOptions& options) {
  std::vector<LidarModel> lidars;
  for (const services::LidarConfig& config : vehicle.lidars) {
    const int number = static_cast<int>(lidars.size());
    LidarModel lidar{};
    lidar.name = config.name;
    lidar.number = number;
    lidar.rate_hz = options.rate_hz;
    lidar.udp_port = port_of(config, number);
    lidar.start_ns = kStartNs + number * kOutOfStep;
    lidar.T_base_sensor = config.geometry.T_base_sensor;
    calibrate_beams(lidar, options.seed);
    lidars.push_back(lidar);
  }
  return lidars;
}

tl::expected<void, std::string> simulate(const services::VehicleConfig& vehicle,
                                         const RecordingOptions& options, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return tl::unexpected(directory + ": " + error.message());

  const World world({options.seed, options.length_m(), options.speed_mps});
  const Trajectory trajectory(world.landscape(), options.speed_mps, options.length_m(),
                              vehicle.mapper.vehicle.base_height_m);
  const Scene scene{world, trajectory, options};
  return write_recording(scene, make_lidars(vehicle, options), directory).and_then([&] {
    return write_truth(scene, sample_truth(scene, vehicle.mapper.map.resolution_xy_m), directory);
  });
}

}  // namespace gvom::sim
