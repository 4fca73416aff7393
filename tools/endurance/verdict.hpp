// What the soak says at its end.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/endurance/faults.hpp"
#include "tools/endurance/health_watch.hpp"
#include "tools/endurance/ledger.hpp"
#include "tools/endurance/record.hpp"
#include "tools/endurance/rounds.hpp"

namespace gvom::endurance {

/// The bounds on what may change from the first to the last quarter of the samples after the warm-up.
/// Private memory: pages come one by one when a code path is taken first; a loss of 64 bytes for every map of
/// one lidar is more than this in half an hour.
inline constexpr double kMostGrowth_bytes = 1024 * 1024;
inline constexpr double kMostChunks = 1;    ///< Used ones of a pool, when they are fewest: maps under way.
inline constexpr double kLeastClean = 0.9;  ///< Share of the rounds, without faults made.

/// Everything that is judged.
struct Run {
  std::string how;  ///< "systemd" or "processes"
  double planned_s = 0;
  double lasted_s = 0;
  std::vector<std::string> lidars;
  bool faults_made = false;
  std::uint32_t seed = 0;
  std::string broken_off;  ///< Why it ended before its time, in words; else empty.
  std::uint64_t packets_sent = 0;
  std::uint64_t layers_heard = 0;
  std::uint64_t layers_missed = 0;  ///< By the soak's own reader, counted.
  std::uint64_t voxel_maps_heard = 0;
  double latency_p50_ms = 0, latency_p99_ms = 0, latency_max_ms = 0;
  const RoundBook* rounds = nullptr;
  const Ledger* ledger = nullptr;
  const HealthWatch* health = nullptr;
  const Record* record = nullptr;
  std::vector<FaultResult> faults;
};

/// One quantity of one process or pool over one life.
struct Judged {
  std::string what;
  std::string unit;
  Growth growth;
  double bound;  ///< On the change.
  bool leaks;
};

/// Of all that lived long enough.
std::vector<Judged> judge_growth(const Record& record);

/// In words; empty: all is well.
std::vector<std::string> failures_of(const Run& run);

/// The whole verdict as JSON.
std::string json_of(const Run& run);

}  // namespace gvom::endurance
