// gvom-bench: how long the mapping takes, beside the obvious way and OctoMap, on the same sweeps in the same
// run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>

#include "services/common/exit_code.hpp"
#include "tools/benchmark/machine.hpp"
#include "tools/benchmark/measure.hpp"
#include "tools/benchmark/report.hpp"

namespace {

using namespace gvom::bench;
using gvom::services::ExitCode;

constexpr int kWindows[] = {1, 8, 32, 128};

struct Options {
  std::string sweeps;
  std::string odometry;
  std::string json;
  double sensor_height_m = 1.73;
  int repeats = 20;
  bool octomap = true;
};

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", std::string("gvom-bench ") + GVOM_VERSION);
  app.add_option("--sweeps", options.sweeps,
                 "folder of KITTI's .bin files with times.txt (without: a synthetic street)")
      ->type_name("FOLDER");
  app.add_option("--odometry", options.odometry,
                 "T_odom_base around the sweeps (default: odometry.tum beside FOLDER)")
      ->type_name("FILE.tum");
  app.add_option("--sensor-height", options.sensor_height_m, "metres of the lidar above base_link")
      ->capture_default_str();
  app.add_option("--repeats", options.repeats, "times over the recording")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_flag("!--no-octomap", options.octomap, "leave OctoMap out");
  app.add_option("--json", options.json, "file for the same figures as JSON")->type_name("FILE");
}

tl::expected<Recording, std::string> open(const Options& options) {
  if (options.sweeps.empty()) return make_street();
  const std::string beside = options.sweeps + "/../odometry.tum";
  return read_recording(options.sweeps, options.odometry.empty() ? beside : options.odometry,
                        options.sensor_height_m);
}

void add_ingest(const IngestTimes& times, Report& report) {
  const auto sweeps = static_cast<double>(report.sweeps);
  report.passes_per_sweep = static_cast<double>(times.passes) / sweeps;
  report.ns_per_pass = times.both.quantile_ms(0.5) * 1e6 / report.passes_per_sweep;
  report.add("ingest: count", times.count);
  report.add("ingest: write", times.write);
  report.add("ingest", times.both);
  report.add("straight loop over the exact walk", times.straight, "ingest");
}

void add_octomap([[maybe_unused]] const Recording& recording, [[maybe_unused]] Report& report) {
#ifdef GVOM_OCTOMAP
  const OctomapTimes times = measure_octomap(recording, 2);
  report.add("OctoMap", times.every_ray, "ingest");
  report.add("OctoMap, discretized", times.discretized, "ingest");
#else
  std::fputs("gvom-bench: built without OctoMap\n", stderr);
#endif
}

void add_fusion(const FusionTimes& times, Report& report) {
  const std::string window = "window " + std::to_string(times.window);
  report.add(window + ": fuse", times.fuse);
  report.add(window + ": layers", times.layers);
  report.add(window + ": fuse and layers", times.both, "window 1: fuse and layers");
}

int fail(const std::string& message, ExitCode code) {
  std::fprintf(stderr, "gvom-bench: %s\n", message.c_str());
  return to_int(code);
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

  Report report{machine(), recording->name, recording->sweeps.size(), 0, 0, 0, {}};
  for (const gvom::Sweep& sweep : recording->sweeps)
    report.returns_per_sweep +=
        static_cast<double>(sweep.returns.size()) / static_cast<double>(report.sweeps);
  const IngestTimes ingest = measure_ingest(*recording, options.repeats);
  if (!ingest.passes_agree) return fail("passes differ from the straight loop's", ExitCode::internal);
  add_ingest(ingest, report);
  if (options.octomap) add_octomap(*recording, report);
  for (const int window : kWindows)
    add_fusion(measure_fusion(*recording, ingest.maps, window, 10 * options.repeats), report);

  std::fputs(table(report).c_str(), stdout);
  if (options.json.empty()) return 0;
  std::ofstream file(options.json);
  file << to_json(report);
  file.close();
  return file ? 0 : fail(options.json + ": cannot be written", ExitCode::unavailable);
}
