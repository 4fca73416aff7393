// Simulated sweeps that are kept in files: mapping rules are tuned without simulating again.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/sim/sweep_simulator.hpp"

namespace gvom::evaluation {

/// Sweeps `first` to `first + count - 1` of one lidar on one drive.
struct SweepSpan {
  int first = 0;
  int count = 0;
};

/// Measures sweeps, or reads them if they were measured before. A file belongs to all that its sweeps depend
/// on: the world, the drive, the lidar, the seed, the losses, and the simulator, of which some columns are
/// measured anew and compared.
class SweepCache {
 public:
  /// `directory` empty: nothing is kept. Errors name the file and the reason.
  static tl::expected<SweepCache, std::string> open(const sim::SweepSimulator& simulator,
                                                    const SweepSpan& span, std::uint64_t world_key,
                                                    const std::string& directory);

  /// Each sweep of the span once, in order.
  tl::expected<void, std::string> next(Sweep& out);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  SweepCache(const sim::SweepSimulator& simulator, const SweepSpan& span);

  const sim::SweepSimulator* simulator_;
  SweepSpan span_;
  int done_ = 0;
  std::string path_;
  std::unique_ptr<std::FILE, Close> reads_, writes_;
  std::vector<std::uint16_t> range_units_;  // of one sweep: [column][beam]
};

/// A number for all that can be measured in a world: its ground, its things, its rain, its walkers.
std::uint64_t key_of(const sim::WorldData& world);

}  // namespace gvom::evaluation
