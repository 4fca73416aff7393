// The scene "trail": an off-road trail past trees, bushes and rocks, with a ditch across it at x = 30 m, a
// step to its left at 12 m, a branch over it at 45 m and a person who crosses it at 38 m.
#pragma once

#include "tools/sim/scene_library.hpp"

namespace gvom::sim {

WorldData make_trail(const SceneParameters& parameters);

}  // namespace gvom::sim
