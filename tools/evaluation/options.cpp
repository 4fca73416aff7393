#include "tools/evaluation/options.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "services/common/config_file.hpp"

namespace gvom::evaluation {
namespace {

constexpr double kLidarHeight_m = 1.7;
constexpr double kFastSpeed_mps = 12.0;
constexpr sim::OdometryNoise kFastNoise{0.02, 0.002};
const std::vector<std::string> kQuickScenes = {"flat",   "hills",  "ditch-2m-b", "bank-down",
                                               "forest", "bushes", "street",     "walker"};

tl::expected<mapping::Vehicle, std::string> make_vehicle(const Options& options) {
  if (options.vehicle.empty()) {
    if (!options.sets.empty()) return tl::unexpected(std::string("--set needs --vehicle"));
    mapping::Vehicle vehicle;
    vehicle.lidars.emplace_back();
    vehicle.lidars.back().T_base_sensor.translation().z() = kLidarHeight_m;
    return vehicle;
  }
  const auto config = services::load_vehicle_config(options.vehicle, options.sets);
  if (!config) return tl::unexpected(config.error().text());
  mapping::Vehicle vehicle{config->mapper, {}};
  for (const services::LidarConfig& lidar : config->lidars) vehicle.lidars.push_back(lidar.geometry);
  return vehicle;
}

tl::expected<std::vector<sim::Sensor>, std::string> find_sensors(const std::vector<std::string>& names) {
  std::vector<sim::Sensor> sensors;
  for (const std::string& name : names) {
    const auto sensor = sim::find_sensor(name);
    if (!sensor) return tl::unexpected(sensor.error());
    sensors.push_back(*sensor);
  }
  return sensors;
}

tl::expected<std::vector<std::string>, std::string> find_scenes(const Options& options) {
  std::vector<std::string> known;
  for (const sim::SceneEntry& entry : sim::scene_library()) known.emplace_back(entry.name);
  if (options.scenes.empty() && !options.quick) return known;
  if (!options.recordings.empty() && options.scenes == std::vector<std::string>{"none"})
    return std::vector<std::string>{};
  const std::vector<std::string>& wanted = options.scenes.empty() ? kQuickScenes : options.scenes;
  for (const std::string& name : wanted) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return tl::unexpected(sim::build_scene(name, {}).error());
  }
  return wanted;
}

std::vector<DriveKind> make_drives(const Options& options, const std::vector<sim::Sensor>& sensors) {
  const sim::OdometryNoise noise =
      options.noise.empty() ? sim::OdometryNoise{} : sim::OdometryNoise{options.noise[0], options.noise[1]};
  std::vector<DriveKind> drives{{"trail", options.speed_mps, noise, sensors}};
  const bool as_given = options.speed_mps != Options{}.speed_mps || !options.noise.empty();
  const auto os1_64 = std::find(sensors.begin(), sensors.end(), sim::Sensor::os1_64);
  if (!as_given && !options.quick && os1_64 != sensors.end())
    drives.push_back({"fast", kFastSpeed_mps, kFastNoise, {*os1_64}});
  return drives;
}

}  // namespace

void add_options(CLI::App& app, Options& options) {
  app.add_option("--scenes", options.scenes, "some of the library's scenes: a,b,c; else all")->delimiter(',');
  app.add_option("--sensors", options.sensors, "os1-64,os1-128,vlp-16, or some of them")->delimiter(',');
  app.add_option("--speed", options.speed_mps, "metres per second; without the fast drive")
      ->check(CLI::Range(0.5, 30.0))
      ->capture_default_str();
  app.add_option("--noise", options.noise, "of the odometry, metres and radians; without the fast drive")
      ->expected(2)
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", options.seed, "another seed, other worlds")->capture_default_str();
  app.add_option("--frames", options.frames, "maps of a drive, after the window is full")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "scenes at a time; they do not change a figure")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_flag("--quick", options.quick, "eight scenes, an OS1-64, without the fast drive");
  app.add_flag("--json", options.json, "print JSON instead of the table");
  app.add_option("--csv", options.csv, "file for all figures");
  app.add_option("--baseline", options.baseline, "file to compare with; exit code 1 if a figure is worse");
  app.add_option("--write-baseline", options.write_baseline, "file for the figures to compare with later");
  app.add_option("--pictures", options.pictures, "directory for a picture of each scene");
  app.add_option("--cache", options.cache, "directory that keeps simulated sweeps for the next run");
  app.add_option("--recordings", options.recordings,
                 "directory of real recordings to map as well; with --scenes none alone");
  app.add_option("--vehicle", options.vehicle, "vehicle file with mapping parameters and the lidars' places");
  app.add_option("--set", options.sets, "KEY=VALUE over the vehicle file")->type_name("KEY=VALUE");
}

tl::expected<Plan, std::string> make_plan(const Options& options) {
  const std::vector<std::string> all_sensors{"os1-64", "os1-128", "vlp-16"};
  const auto sensors = find_sensors(!options.sensors.empty() ? options.sensors
                                    : options.quick          ? std::vector<std::string>{"os1-64"}
                                                             : all_sensors);
  if (!sensors) return tl::unexpected(sensors.error());
  const auto scenes = find_scenes(options);
  if (!scenes) return tl::unexpected(scenes.error());
  const auto vehicle = make_vehicle(options);
  if (!vehicle) return tl::unexpected(vehicle.error());
  if (!options.recordings.empty() && !std::filesystem::is_directory(options.recordings))
    return tl::unexpected("--recordings " + options.recordings + ": is not a directory");
  Plan plan;
  plan.scenes = *scenes;
  plan.drives = make_drives(options, *sensors);
  plan.vehicle = *vehicle;
  plan.seed = options.seed;
  plan.frames = options.frames;
  plan.threads = options.threads;
  plan.cache_directory = options.cache;
  plan.pictures_directory = options.pictures;
  plan.recordings_directory = options.recordings;
  return plan;
}

std::string settings_of(const Plan& plan, const Options& options) {
  char text[160];
  const DriveKind& drive = plan.drives.front();
  std::snprintf(text, sizeof text, "seed %llu, frames %d, trail at %g m/s, odometry off by %g m and %g rad",
                static_cast<unsigned long long>(plan.seed), plan.frames, drive.speed_mps,
                drive.odometry_noise.position_m, drive.odometry_noise.rotation_rad);
  std::string settings = text;
  if (!options.vehicle.empty()) settings += ", vehicle " + options.vehicle;
  for (const std::string& set : options.sets) settings += ", " + set;
  return settings;
}

}  // namespace gvom::evaluation
