// The library of scenes: each a world with one difficulty, or all of them, drawn from a seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/sim/world_data.hpp"

namespace gvom::sim {

struct SceneParameters {
  std::uint64_t seed = 1;
  double length_m = 60.0;  ///< Of the path, at least; a scene with an end (a ditch, a cliff) stops before it.
  double speed_mps = 5.0;  ///< Walkers cross just ahead of a vehicle this fast.
};

struct SceneEntry {
  const char* name;     ///< As in `--scene NAME`.
  const char* summary;  ///< One line for `--scene list`.
  WorldData (*build)(const SceneParameters&);
};

/// In the order of `--scene list`.
const std::vector<SceneEntry>& scene_library();

/// The error names the scene, and the nearest names that there are.
tl::expected<WorldData, std::string> build_scene(const std::string& name, const SceneParameters& parameters);

}  // namespace gvom::sim
