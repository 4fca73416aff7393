// The command line of gvom-evaluate.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <tl/expected.hpp>

#include "tools/evaluation/run.hpp"

namespace gvom::evaluation {

struct Options {
  std::vector<std::string> scenes;
  std::vector<std::string> sensors;
  double speed_mps = 5.0;
  std::vector<double> noise;  ///< Metres, radians.
  std::uint64_t seed = 1;
  int frames = 40;
  int threads = 2;
  bool quick = false;
  bool json = false;
  std::string csv;
  std::string baseline;
  std::string write_baseline;
  std::string pictures;
  std::string cache;
  std::string recordings;
  std::string vehicle;
  std::vector<std::string> sets;
};

void add_options(CLI::App& app, Options& options);

/// What is to be run. Errors: an unknown scene or sensor, a vehicle file that is wrong.
tl::expected<Plan, std::string> make_plan(const Options& options);

/// All that the figures depend on beside the code, in words: two baselines of other settings do not compare.
std::string settings_of(const Plan& plan, const Options& options);

}  // namespace gvom::evaluation
