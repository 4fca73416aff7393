// The scenes, each a pure function of its parameters. What they show is in `scene_library.cpp`.
#pragma once

#include "tools/sim/scene_library.hpp"

namespace gvom::sim {

// slopes.cpp
WorldData make_flat(const SceneParameters& parameters);
WorldData make_hills(const SceneParameters& parameters);
WorldData make_ramp_up(const SceneParameters& parameters);
WorldData make_ramp_down(const SceneParameters& parameters);
WorldData make_ramp_sharp(const SceneParameters& parameters);
WorldData make_sidehill(const SceneParameters& parameters);
WorldData make_crest(const SceneParameters& parameters);
WorldData make_bumps(const SceneParameters& parameters);

// drops.cpp
WorldData make_bank_down(const SceneParameters& parameters);
WorldData make_bank_up(const SceneParameters& parameters);
WorldData make_cliff(const SceneParameters& parameters);
WorldData make_potholes(const SceneParameters& parameters);

// ditches.cpp
WorldData make_ditch_2m_a(const SceneParameters& parameters);
WorldData make_ditch_2m_b(const SceneParameters& parameters);
WorldData make_ditch_2m_c(const SceneParameters& parameters);
WorldData make_ditch_1m_a(const SceneParameters& parameters);
WorldData make_ditch_1m_b(const SceneParameters& parameters);
WorldData make_ditch_1m_c(const SceneParameters& parameters);
WorldData make_ditch_oblique(const SceneParameters& parameters);
WorldData make_ditch_slope(const SceneParameters& parameters);
WorldData make_ditch_slope_down(const SceneParameters& parameters);
WorldData make_ditch_rough(const SceneParameters& parameters);

// vegetation.cpp
WorldData make_forest(const SceneParameters& parameters);
WorldData make_forest_low(const SceneParameters& parameters);
WorldData make_bushes(const SceneParameters& parameters);
WorldData make_grass_fields(const SceneParameters& parameters);
WorldData make_rocks(const SceneParameters& parameters);

// built.cpp
WorldData make_walls(const SceneParameters& parameters);
WorldData make_street(const SceneParameters& parameters);

// encounters.cpp
WorldData make_branches(const SceneParameters& parameters);
WorldData make_walkers(const SceneParameters& parameters);

// sensing.cpp
WorldData make_puddles(const SceneParameters& parameters);
WorldData make_dark(const SceneParameters& parameters);
WorldData make_dusty(const SceneParameters& parameters);
WorldData make_rain(const SceneParameters& parameters);

// mixed.cpp
WorldData make_mixed(const SceneParameters& parameters);

}  // namespace gvom::sim
