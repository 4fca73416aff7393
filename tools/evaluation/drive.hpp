// One drive: sweeps are simulated and mapped, and the maps judged.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <tl/expected.hpp>

#include "tools/evaluation/judge.hpp"
#include "tools/evaluation/stage.hpp"
#include "tools/evaluation/sweep_cache.hpp"
#include "tools/mapping/pipeline.hpp"

namespace gvom::evaluation {

struct DriveOptions {
  sim::Sensor sensor = sim::Sensor::os1_64;  ///< All lidars are of this kind.
  sim::OdometryNoise odometry_noise;
  std::uint64_t seed = 1;
  int frames = 40;              ///< Mapped after the window is full.
  std::string cache_directory;  ///< Of SweepCache; empty: none.
};

/// Is shown each judged map.
using Watch = std::function<void(const Frame&)>;

/// Drives the part of the path that says most: up to the first hole, else from the path's start. Judges every
/// map where there are holes or walkers, else every second one. Errors say what could not be mapped or read.
tl::expected<Figures, std::string> drive(const Stage& stage, const mapping::Vehicle& vehicle,
                                         const DriveOptions& options, const Watch& watch = {});

}  // namespace gvom::evaluation
