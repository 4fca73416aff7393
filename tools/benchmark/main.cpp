// gvom-bench: how long the mapping takes, beside the obvious way and OctoMap, or on the GPU beside the CPU;
// on the same sweeps in the same run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>

#include "services/common/exit_code.hpp"
#include "tools/benchmark/cpu.hpp"
#include "tools/benchmark/gpu.hpp"
#include "tools/benchmark/gpu_report.hpp"
#include "tools/benchmark/report.hpp"

namespace {

using namespace gvom::bench;
using gvom::services::ExitCode;

struct Options {
  std::string sweeps;
  std::string odometry;
  std::string lidar = kStreetLidars[0].name;
  std::string json;
  double sensor_height_m = 1.73;
  int repeats = 20;
  bool octomap = true;
  bool gpu = false;
  bool quick = false;
};

std::vector<std::string> lidar_names() {
  std::vector<std::string> names;
  for (const StreetLidar& lidar : kStreetLidars) names.emplace_back(lidar.name);
  return names;
}

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", std::string("gvom-bench ") + GVOM_VERSION);
  auto* sweeps = app.add_option("--sweeps", options.sweeps,
                                "folder of KITTI's .bin files with times.txt (without: a synthetic street)")
                     ->type_name("FOLDER");
  app.add_option("--odometry", options.odometry,
                 "T_odom_base around the sweeps (default: odometry.tum beside FOLDER)")
      ->type_name("FILE.tum");
  app.add_option("--sensor-height", options.sensor_height_m, "metres of the lidar above base_link")
      ->capture_default_str();
  app.add_option("--lidar", options.lidar, "what drives along the synthetic street")
      ->check(CLI::IsMember(lidar_names()))
      ->excludes(sweeps)
      ->capture_default_str();
  app.add_option("--repeats", options.repeats, "times over the recording")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_flag("!--no-octomap", options.octomap, "leave OctoMap out");
  auto* gpu =
      app.add_flag("--gpu", options.gpu,
                   "the CUDA back end beside the CPU's, for several grids and windows, and nothing else");
  app.add_flag("--quick", options.quick, "with --gpu: one small grid and window, to try it")->needs(gpu);
  app.add_option("--json", options.json, "file for the same figures as JSON")->type_name("FILE");
}

tl::expected<Recording, std::string> open(const Options& options) {
  if (!options.sweeps.empty()) {
    const std::string beside = options.sweeps + "/../odometry.tum";
    return read_recording(options.sweeps, options.odometry.empty() ? beside : options.odometry,
                          options.sensor_height_m);
  }
  const StreetLidar* lidar = kStreetLidars;
  while (options.lidar != lidar->name) ++lidar;
  return make_street(*lidar);
}

int fail(const std::string& message, ExitCode code) {
  std::fprintf(stderr, "gvom-bench: %s\n", message.c_str());
  return to_int(code);
}

struct Output {
  std::string text;
  nlohmann::ordered_json json;
};

tl::expected<Output, Failure> measure(const Options& options, const Recording& recording,
                                      const std::string& command) {
  const Setting setting = setting_of(recording, command);
  if (options.gpu) {
    const auto comparison = compare_with_gpu(recording, options.repeats, options.quick);
    if (!comparison) return tl::make_unexpected(comparison.error());
    return Output{markdown(setting, *comparison), to_json(setting, *comparison)};
  }
  const auto report = measure_cpu(setting, recording, options.repeats, options.octomap);
  if (!report) return tl::make_unexpected(report.error());
  return Output{table(*report), to_json(*report)};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures ingest, fusion and layers.", "gvom-bench");
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return to_int(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage);
  }
  const auto recording = open(options);
  if (!recording) return fail(recording.error(), ExitCode::bad_data);
  std::string command = "gvom-bench";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  const auto output = measure(options, *recording, command);
  if (!output) return fail(output.error().what, output.error().code);

  std::fputs(output->text.c_str(), stdout);
  if (options.json.empty()) return 0;
  std::ofstream file(options.json);
  file << output->json.dump(2) << "\n";
  file.close();
  return file ? 0 : fail(options.json + ": cannot be written", ExitCode::unavailable);
}
