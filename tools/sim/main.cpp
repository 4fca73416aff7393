// gvom-sim: makes a recording of a simulated off-road drive, with the truth beside it.
#include <chrono>
#include <cstdio>
#include <thread>

#include "services/common/cli.hpp"
#include "tools/sim/simulate.hpp"

namespace {

constexpr double kLongestDrive = 1000.0;  // metres: the ground is held in memory at 0.1 m

void add_options(CLI::App& app, gvom::sim::RecordingOptions& options, std::string& directory) {
  app.add_option("--out", directory, "directory for the recording and its truth")->required();
  app.add_option("--seconds", options.seconds, "how long to drive")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--speed", options.speed_mps, "metres per second")
      ->check(CLI::Range(0.1, 50.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "another seed, another world")->capture_default_str();
  app.add_option("--odometry-noise-m", options.odometry_noise.position_m,
                 "standard deviation, metres, each axis")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--odometry-noise-rad", options.odometry_noise.rotation_rad,
                 "standard deviation, radians, each axis")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--range-noise-m", options.range_noise_m, "standard deviation, metres")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--rate", options.rate_hz, "turns of the lidars a second")
      ->check(CLI::IsMember({10, 20}))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads; they do not change a byte")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
  using gvom::services::ExitCode;
  gvom::services::Cli cli(
      "gvom-sim",
      "Simulates an off-road drive past trees, bushes, rocks, a ditch, a step, a branch and a\n"
      "person, and writes what the vehicle's lidars see: NAME.pcap and NAME.json for each,\n"
      "odometry.tum, and the truth as .npy with truth.json. Same seed, same bytes.");
  gvom::sim::RecordingOptions options;
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string directory;
  add_options(cli.app(), options, directory);
  cli.app().footer("Example:\n  gvom-sim --config vehicle.yaml --out FOLDER --seconds 10");
  const auto vehicle = cli.parse(argc, argv);
  if (!vehicle) return to_int(vehicle.error());
  if (options.length_m() > kLongestDrive) {
    std::fprintf(stderr, "gvom-sim: %.0f m of trail are too long, at most %.0f m\n", options.length_m(),
                 kLongestDrive);
    return to_int(ExitCode::usage);
  }

  const auto start = std::chrono::steady_clock::now();
  const auto written = gvom::sim::simulate(*vehicle, options, directory);
  if (!written) {
    std::fprintf(stderr, "gvom-sim: %s\n", written.error().c_str());
    return to_int(ExitCode::unavailable);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%s: %d sweeps of %zu lidars over %.1f m, seed %llu, in %.1f s\n", directory.c_str(),
              options.sweeps(), vehicle->lidars.size(), options.length_m(),
              static_cast<unsigned long long>(options.seed), took.count());
  return 0;
}
