// gvom-evaluate: how far the map is from the truth, in simulated scenes.
#include <cstdio>
#include <fstream>

#include "services/common/exit_code.hpp"
#include "tools/evaluation/baseline.hpp"
#include "tools/evaluation/options.hpp"
#include "tools/evaluation/recording_run.hpp"
#include "tools/evaluation/report.hpp"

namespace {

using gvom::services::ExitCode;
using namespace gvom::evaluation;

int fail(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "gvom-evaluate: %s\n", message.c_str());
  return to_int(code);
}

void print_progress(int done, int of, const std::string& scene, double took_s) {
  std::fprintf(stderr, "[%d/%d] %s, %.1f s\n", done, of, scene.c_str(), took_s);
}

bool write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  return static_cast<bool>(file);
}

/// Prints what changed; the exit code.
int compare_with(const Baseline& baseline, const std::vector<Row>& rows) {
  const Changes changes = compare(baseline, rows);
  for (const std::string& line : changes.better) std::fprintf(stderr, "better: %s\n", line.c_str());
  for (const std::string& line : changes.worse) std::fprintf(stderr, "WORSE: %s\n", line.c_str());
  if (changes.recordings_not_run > 0)
    std::fprintf(stderr,
                 "SKIPPED: %d rows of the baseline are of recordings that are not here (--recordings DIR)\n",
                 changes.recordings_not_run);
  std::fprintf(stderr, "against the baseline: %zu figures better, %zu worse", changes.better.size(),
               changes.worse.size());
  if (changes.rows_without_baseline > 0)
    std::fprintf(stderr, "; %d rows are not in it", changes.rows_without_baseline);
  std::fprintf(stderr, "\n");
  return changes.worse.empty() ? 0 : 1;
}

/// Scenes, then recordings.
tl::expected<std::vector<Row>, std::string> run_all(const Plan& plan) {
  auto rows = run(plan, print_progress);
  if (!rows) return rows;
  const auto real =
      run_recordings(plan, [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
  if (!real) return real;
  rows->insert(rows->end(), real->begin(), real->end());
  return rows;
}

int evaluate(const Options& options) {
  const auto plan = make_plan(options);
  if (!plan) return fail(ExitCode::usage, plan.error());
  const std::string settings = settings_of(*plan, options);
  tl::expected<Baseline, std::string> baseline;
  if (!options.baseline.empty()) {
    baseline = read_baseline(options.baseline);
    if (!baseline) return fail(ExitCode::bad_data, baseline.error());
    if (baseline->settings != settings)
      return fail(ExitCode::usage, options.baseline + " is of other settings: " + baseline->settings +
                                       "; these are: " + settings);
  }
  const auto rows = run_all(*plan);
  if (!rows) return fail(ExitCode::unavailable, rows.error());
  std::fputs((options.json ? to_json(*rows, settings) : table(*rows)).c_str(), stdout);
  for (const std::string& path : {options.csv, options.write_baseline})
    if (!path.empty() && !write_file(path, to_csv(*rows, settings)))
      return fail(ExitCode::unavailable, path + ": cannot be written");
  return options.baseline.empty() ? 0 : compare_with(*baseline, *rows);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Drives through simulated scenes, maps what the lidars see, and says how far the map is from what is\n"
      "really there: one line a scene and sensor, then the goals, each with its worst scene.",
      "gvom-evaluate");
  app.set_version_flag("--version", std::string("gvom-evaluate ") + GVOM_VERSION);
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return to_int(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage);
  }
  return evaluate(options);
}
