#include "tools/sim/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "tools/sim/truth_files.hpp"

namespace gvom::sim {
namespace {

constexpr int kFirstPort = 7502;
constexpr std::int64_t kOutOfStep = 37'100'000;  // nanoseconds between the lidars' first columns
constexpr double kSpare = 0.5;                   // metres that rounded corners may cut off a path
constexpr double kExact = 1e-6;                  // sweeps: less is rounding

int port_of(const services::LidarConfig& lidar, int number) {
  for (const std::string scheme : {"ouster-udp:", "velodyne-udp:"}) {
    if (lidar.source.compare(0, scheme.size(), scheme) != 0) continue;
    const int port = std::atoi(lidar.source.c_str() + scheme.size());
    if (port > 0 && port < 65536) return port;
  }
  return kFirstPort + number;
}

double last_start_s(const services::VehicleConfig& vehicle) {
  return 1e-9 * static_cast<double>(kOutOfStep) * static_cast<double>(vehicle.lidars.size() - 1);
}

}  // namespace

std::vector<LidarModel> make_lidars(const services::VehicleConfig& vehicle, const RecordingOptions& options) {
  std::vector<LidarModel> lidars;
  for (const services::LidarConfig& config : vehicle.lidars) {
    const int number = static_cast<int>(lidars.size());
    const LidarPlace place{config.name, number, port_of(config, number), kStartNs + number * kOutOfStep,
                           config.geometry.T_base_sensor};
    lidars.push_back(make_lidar(options.sensor, place, options.rate_hz, options.sweep.seed));
  }
  return lidars;
}

double path_length_m(const services::VehicleConfig& vehicle, const RecordingOptions& options) {
  return options.length_m() + last_start_s(vehicle) * options.speed_mps + kSpare;
}

tl::expected<Simulated, std::string> simulate(const services::VehicleConfig& vehicle, const World& world,
                                              const RecordingOptions& options, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return tl::unexpected(directory + ": " + error.message());

  const Trajectory trajectory(world.terrain(), world.data().path_m,
                              {options.speed_mps, vehicle.mapper.vehicle.base_height_m});
  const double possible = (trajectory.seconds() - last_start_s(vehicle)) * options.rate_hz;
  const double wanted = options.seconds * options.rate_hz;
  const int sweeps = static_cast<int>(std::min(std::floor(possible + kExact), std::round(wanted)));
  if (sweeps < 1)
    return tl::unexpected(world.data().name + ": its path is too short for a sweep of each lidar");
  const Scene scene{world, trajectory, options, make_lidars(vehicle, options), sweeps};
  const double seconds = std::min(options.seconds, trajectory.seconds());
  const TruthOptions truth{vehicle.mapper.map.resolution_xy_m, seconds, options.threads};
  return write_recording(scene, directory)
      .and_then([&] { return write_truth(scene, sample_truth(world, truth), directory); })
      .map([&] {
        return Simulated{sweeps, seconds * options.speed_mps};
      });
}

}  // namespace gvom::sim
