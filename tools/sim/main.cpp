// gvom-sim: makes a recording of a simulated off-road drive, with the truth beside it.
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "services/common/cli.hpp"
#include "tools/sim/scene_library.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/world_files.hpp"

namespace {

using gvom::services::ExitCode;
using gvom::sim::RecordingOptions;
using gvom::sim::WorldData;

/// "list" prints the scenes and ends the program, without a vehicle.
std::string list_scenes(const std::string& name) {
  if (name != "list") return {};
  for (const gvom::sim::SceneEntry& entry : gvom::sim::scene_library())
    std::printf("%-16s %s\n", entry.name, entry.summary);
  throw CLI::Success();
}

constexpr double kLongestDrive = 1000.0;  // metres: the ground is held in memory at 0.1 m

struct Options {
  RecordingOptions recording;
  std::string scene = "trail";
  std::string world;  // a folder
  std::string save_world;
  std::string sensor = "os1-64";
  bool no_losses = false;
  std::string out;
};

void add_options(CLI::App& app, Options& options) {
  RecordingOptions& recording = options.recording;
  app.add_option("--out", options.out, "directory for the recording and its truth");
  auto* scene = app.add_option("--scene", options.scene, "which world; \"list\" lists them")
                    ->check(list_scenes)
                    ->capture_default_str();
  app.add_option("--world", options.world, "directory with a world of your own: ground.npy and objects.json")
      ->excludes(scene);
  app.add_option("--save-world", options.save_world, "directory to write the world to");
  app.add_option("--sensor", options.sensor, "all lidars are of this kind")
      ->check(CLI::IsMember({"os1-64", "os1-128", "vlp-16"}))
      ->capture_default_str();
  app.add_flag("--no-losses", options.no_losses, "weak returns come back too");
  app.add_option("--seconds", recording.seconds, "how long to drive")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--speed", recording.speed_mps, "metres per second")
      ->check(CLI::Range(0.1, 50.0))
      ->capture_default_str();
  app.add_option("--seed", recording.sweep.seed, "another seed, another world")->capture_default_str();
  app.add_option("--odometry-noise-m", recording.odometry_noise.position_m,
                 "standard deviation, metres, each axis")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--odometry-noise-rad", recording.odometry_noise.rotation_rad,
                 "standard deviation, radians, each axis")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--range-noise-m", recording.sweep.range_noise_m, "standard deviation, metres")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--rate", recording.rate_hz, "turns of the lidars a second")
      ->check(CLI::IsMember({10, 20}))
      ->capture_default_str();
  app.add_option("--threads", recording.threads, "threads; they do not change a byte")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
}

/// The code to exit with, as the world came from a file or a name.
int refuse(ExitCode code, const std::string& why) {
  std::fprintf(stderr, "gvom-sim: %s\n", why.c_str());
  return to_int(code);
}

/// What the command line alone shows to be wrong; empty: nothing.
std::string complaint(const Options& options) {
  if (options.out.empty()) return "--out is required";
  if (options.sensor == "vlp-16" && options.recording.rate_hz != 10)
    return "a vlp-16 turns at --rate 10 only";
  const double length_m = options.recording.length_m();
  if (length_m > kLongestDrive)
    return std::to_string(static_cast<int>(length_m)) + " m are too long a drive, at most 1000 m";
  return {};
}

int run(const gvom::services::VehicleConfig& vehicle, const Options& options) {
  const RecordingOptions& recording = options.recording;
  const auto start = std::chrono::steady_clock::now();
  tl::expected<WorldData, std::string> data =
      options.world.empty()
          ? gvom::sim::build_scene(
                options.scene, {recording.sweep.seed, path_length_m(vehicle, recording), recording.speed_mps})
          : gvom::sim::read_world(options.world);
  if (!data) return refuse(options.world.empty() ? ExitCode::usage : ExitCode::bad_data, data.error());
  if (!options.save_world.empty()) {
    const auto saved = gvom::sim::save_world(*data, options.save_world);
    if (!saved) return refuse(ExitCode::unavailable, saved.error());
  }
  const gvom::sim::World world(std::move(*data));
  const auto made = gvom::sim::simulate(vehicle, world, recording, options.out);
  if (!made) return refuse(ExitCode::unavailable, made.error());

  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (made->driven_m < recording.length_m() - 0.01)
    std::printf("the path of %s ends after %.1f m: the recording ends there\n", world.data().name.c_str(),
                made->driven_m);
  std::printf("%s: %d sweeps of %zu lidars over %.1f m of %s, seed %llu, in %.1f s\n", options.out.c_str(),
              made->sweeps, vehicle.lidars.size(), made->driven_m, world.data().name.c_str(),
              static_cast<unsigned long long>(recording.sweep.seed), took.count());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  gvom::services::Cli cli(
      "gvom-sim",
      "Simulates a drive through a world with complete truth, and writes what the vehicle's lidars\n"
      "see: NAME.pcap and, of an Ouster, NAME.json for each, odometry.tum, and the truth as .npy\n"
      "with truth.json. Same seed, same bytes.");
  Options options;
  options.recording.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  add_options(cli.app(), options);
  cli.app().footer(
      "Examples:\n  gvom-sim --config vehicle.yaml --out FOLDER --seconds 10\n"
      "  gvom-sim --scene list");
  const auto vehicle = cli.parse(argc, argv);
  if (!vehicle) return to_int(vehicle.error());
  const std::string wrong = complaint(options);
  if (!wrong.empty()) return refuse(ExitCode::usage, wrong);
  options.recording.sweep.losses.enabled = !options.no_losses;
  options.recording.sensor = *gvom::sim::find_sensor(options.sensor);
  return run(*vehicle, options);
}
