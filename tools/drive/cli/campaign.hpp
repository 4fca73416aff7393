// Many drives, and a table of them.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/drive/cli/session.hpp"
#include "tools/drive/cli/witness.hpp"

namespace gvom::driving {

struct CampaignOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t last_seed = 1;
  std::set<std::uint64_t> driven;  ///< Not again.
  std::string course;              ///< Of `make_test_world`; empty: random worlds.
  std::string folder_of_world;     ///< A world from files (`sim::read_world`) instead; empty: none.
  double length_m = 300;
  Ablation ablation = Ablation::none;
  sim::Sensor sensor = sim::Sensor::os1_64;
  std::vector<double> noise{0.02, 0.002};  ///< Metres, radians.
  int threads = 1;                         ///< Worlds at a time; they do not change a byte.
  Keeping keeping;
};

/// "7" or "1..200".
bool read_seeds(const std::string& text, CampaignOptions& options);

/// The world of a course, or the random one of a seed. The error names the courses.
tl::expected<CourseWorld, std::string> world_of(const CampaignOptions& options, std::uint64_t seed);

SessionOptions session_options(const CampaignOptions& options, std::uint64_t seed);

struct Row {
  std::string world;
  std::uint64_t seed;
  SessionResult result;
};

/// One line: what came of it, how long it took, what a planner that knows the world would take.
std::string line_of(const Row& row);

/// The same as a sentence.
std::string story_of(const Row& row);

/// Sums over all: arrived of those with a way, mishaps by kind, times, speeds, clearances, cycles.
std::string table_of(const std::vector<Row>& rows);

/// Rows by seed. `done` is called from one thread at a time, as drives end. The first error, by seed.
tl::expected<std::vector<Row>, std::string> run_campaign(const services::VehicleConfig& config,
                                                         const CampaignOptions& options,
                                                         const std::function<void(const Row&)>& done);

}  // namespace gvom::driving
