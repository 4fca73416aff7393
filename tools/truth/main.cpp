// gvom-truth: how well the maps of gvom-map agree with the simulator's truth.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "services/common/exit_code.hpp"
#include "tools/truth/report.hpp"

namespace {

using gvom::services::ExitCode;
using namespace gvom::truth;

struct Options {
  std::string truth;
  std::string map;
  std::string json;
  double within_m = 15.0;
};

tl::expected<Evaluation, std::string> evaluate(const Options& options) {
  const auto truth = read_truth(options.truth);
  if (!truth) return tl::unexpected(truth.error());
  const auto frames = list_frames(options.map);
  if (!frames) return tl::unexpected(frames.error());
  const auto directions = headings(*frames);
  Evaluator evaluator(*truth, options.within_m);
  for (std::size_t i = 0; i < frames->size(); ++i) {
    const FrameInfo& info = (*frames)[i];
    if (std::abs(info.resolution_m - truth->resolution_m) > 1e-9)
      return tl::unexpected(info.directory + ": the map's columns are " + std::to_string(info.resolution_m) +
                            " m wide, the truth's " + std::to_string(truth->resolution_m) + " m");
    const auto frame = read_frame(info);
    if (!frame) return tl::unexpected(frame.error());
    evaluator.add(*frame, directions[i]);
  }
  return evaluator.result();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Compares the maps that gvom-map made of a simulated recording with the truth that gvom-sim wrote.",
      "gvom-truth");
  Options options;
  app.add_option("--truth", options.truth, "directory with truth.json")->required();
  app.add_option("--map", options.map, "directory that gvom-map wrote")->required();
  app.add_option("--within", options.within_m, "metres ahead of the vehicle that count as near")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--json", options.json, "file for the same figures as JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return to_int(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage);
  }

  const auto evaluation = evaluate(options);
  if (!evaluation) {
    std::fprintf(stderr, "gvom-truth: %s\n", evaluation.error().c_str());
    return to_int(ExitCode::bad_data);
  }
  std::fputs(table(*evaluation).c_str(), stdout);
  if (options.json.empty()) return 0;
  std::ofstream file(options.json);
  file << to_json(*evaluation);
  file.close();
  if (file) return 0;
  std::fprintf(stderr, "gvom-truth: %s: cannot be written\n", options.json.c_str());
  return to_int(ExitCode::unavailable);
}
