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
#include "tools/benchmark/hold.hpp"
#include "tools/benchmark/report.hpp"

namespace {

using namespace gvom::bench;
using gvom::services::ExitCode;

struct Options {
  std::string sweeps;
  std::string odometry;
  std::string lidar = kStreetLidars[0].name;
  std::string json;
  std::string summary;
  double sensor_height_m = 1.73;
  bool octomap = true;
  gvom::MemoryConfig memory;
  bool gpu = false;
  bool hold_gpu = false;
  GpuSetting setting;
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
  app.add_option("--repeats", options.setting.repeats,
                 "times over the recording; with --gpu 20 sweeps and ticks each on the GPU, 4 on the CPU")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  auto* memory = app.add_option("--memory", options.memory.max_age_s,
                                "without --gpu: seconds of what is remembered of maps that left the window")
                     ->check(CLI::Range(0.0, 60.0))
                     ->capture_default_str();
  app.add_flag("!--no-octomap", options.octomap, "leave OctoMap out");
  auto* gpu =
      app.add_flag("--gpu", options.gpu,
                   "the CUDA back end beside the CPU's, for several grids and windows, and nothing else");
  app.add_flag("--quick", options.setting.quick, "with --gpu: one small grid and window, to try it")
      ->needs(gpu);
  gpu->excludes(memory);
  app.add_option("--grids", options.setting.grids,
                 "with --gpu: the first so many of 256 x 256 x 64 and 512 x 512 x 128")
      ->check(CLI::Range(1, 2))
      ->needs(gpu)
      ->capture_default_str();
  app.add_flag("--hold-gpu", options.hold_gpu)->group("");  // for gpu-check alone
  app.add_option("--summary", options.summary, "file for the key figures as text")->type_name("FILE");
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
  std::string summary;
  nlohmann::ordered_json json;
};

tl::expected<Output, Failure> measure(const Options& options, const Recording& recording,
                                      const std::string& command) {
  const Setting setting = setting_of(recording, command);
  if (options.gpu) {
    const auto comparison = compare_with_gpu(recording, options.setting);
    if (!comparison) return tl::make_unexpected(comparison.error());
    return Output{markdown(setting, *comparison), summary(setting, *comparison),
                  to_json(setting, *comparison)};
  }
  const auto report =
      measure_cpu(setting, recording, {options.setting.repeats, options.octomap, options.memory});
  if (!report) return tl::make_unexpected(report.error());
  return Output{table(*report), table(*report), to_json(*report)};
}

// True if there is nothing to write, for want of a name, too.
bool write(const std::string& path, const std::string& content) {
  if (path.empty()) return true;
  std::ofstream file(path);
  file << content;
  file.close();
  return static_cast<bool>(file);
}

int fail_to_write(const std::string& path) {
  return fail(path + ": cannot be written", ExitCode::unavailable);
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
  if (options.hold_gpu) {
    const auto held = hold_gpu();
    return held ? 0 : fail(held.error().what, held.error().code);
  }
  const auto recording = open(options);
  if (!recording) return fail(recording.error(), ExitCode::bad_data);
  std::string command = "gvom-bench";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  const auto output = measure(options, *recording, command);
  if (!output) return fail(output.error().what, output.error().code);

  std::fputs(output->text.c_str(), stdout);
  if (!write(options.summary, output->summary)) return fail_to_write(options.summary);
  if (!write(options.json, output->json.dump(2) + "\n")) return fail_to_write(options.json);
  return 0;
}
