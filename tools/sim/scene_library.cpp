#include "tools/sim/scene_library.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/trail.hpp"

namespace gvom::sim {
namespace {

/// Letters to add, take away or change to make one of the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string unknown_scene(const std::string& name) {
  std::map<std::size_t, std::string> names_by_distance;
  for (const SceneEntry& scene : scene_library()) {
    std::string& names = names_by_distance[edit_distance(name, scene.name)];
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  }
  return "scene \"" + name + "\" is unknown; the nearest: " + names_by_distance.begin()->second;
}

}  // namespace

const std::vector<SceneEntry>& scene_library() {
  static const std::vector<SceneEntry> scenes{
      {"trail", "woods along a trail, with a ditch, a step, a branch and a person", make_trail},
      {"flat", "flat ground and nothing else", make_flat},
      {"hills", "rolling hills to 25 degrees with ripples, all of it drivable", make_hills},
      {"ramp-up", "a ramp of 15 degrees up, 20 m long, after 15 m of flat ground, ends rounded",
       make_ramp_up},
      {"ramp-down", "the same ramp down", make_ramp_down},
      {"ramp-sharp", "the same with a sharp upper edge: from before it no lidar can tell it from a cliff",
       make_ramp_sharp},
      {"sidehill", "along a slope of 15 degrees", make_sidehill},
      {"crest", "14 degrees up and down again behind a rounded crest at 20 m", make_crest},
      {"bumps", "bumps across the path, 0.15 to 0.25 m high and 2 to 3 m long", make_bumps},
      {"bank-down", "straight at the upper edge of a bank of 1.5 m, 65 degrees steep", make_bank_down},
      {"bank-up", "straight at the foot of such a bank", make_bank_up},
      {"cliff", "straight at the edge of a cliff of 5 m", make_cliff},
      {"potholes", "potholes 0.8 to 1.2 m wide and 0.3 to 0.6 m deep; on the path one of 0.6 m, at 40 m",
       make_potholes},
      {"ditch-2m-a", "a ditch 2 m wide, 1 m deep; ground 0.01 m above a voxel's face", make_ditch_2m_a},
      {"ditch-2m-b", "the same, ground 0.13 m above a voxel's face", make_ditch_2m_b},
      {"ditch-2m-c", "the same, ground 0.33 m above a voxel's face", make_ditch_2m_c},
      {"ditch-1m-a", "a ditch 1 m wide, 0.6 m deep; ground 0.01 m above a voxel's face", make_ditch_1m_a},
      {"ditch-1m-b", "the same, ground 0.13 m above a voxel's face", make_ditch_1m_b},
      {"ditch-1m-c", "the same, ground 0.33 m above a voxel's face", make_ditch_1m_c},
      {"ditch-oblique", "a ditch 2 m wide, 1 m deep, turned by 35 degrees", make_ditch_oblique},
      {"ditch-slope", "a ditch 2 m wide, 1 m deep, on a slope of 10 degrees upwards", make_ditch_slope},
      {"ditch-slope-down", "the same on a slope downwards", make_ditch_slope_down},
      {"ditch-rough", "a ditch 2 m wide, 1 m deep, in rolling ground with ripples", make_ditch_rough},
      {"forest", "dense woods, trunks of 0.1 to 0.6 m, feet hidden by bushes and grass", make_forest},
      {"forest-low", "the same, with leaves down to 1.3 m at some trees", make_forest_low},
      {"bushes", "thin bushes of 0.6 to 1.8 m on rolling ground", make_bushes},
      {"grass", "fields of tall grass beside and on the trail", make_grass_fields},
      {"rocks", "half-buried rocks 0.3 to 1 m high, some of them in grass", make_rocks},
      {"wall", "a wall of 2 m along the path and one across its end", make_walls},
      {"street", "a street with kerbs, parked cars, lamp posts and houses", make_street},
      {"branches", "a branch 2.5 m above the path and one of 1.2 m across its end", make_branches},
      {"walker", "one person crosses 10 m ahead, one walks along", make_walkers},
      {"puddles", "puddles that mirror, trees and rocks around them", make_puddles},
      {"dark", "patches of ground that give no return", make_dark},
      {"dust", "clouds of dust behind, ahead and beside", make_dusty},
      {"rain", "rain: 0.36 % of the rays end on drops within 30 m", make_rain},
      {"mixed", "hills, woods, rocks, bushes, grass, a ditch, a puddle and a walker", make_mixed},
  };
  return scenes;
}

tl::expected<WorldData, std::string> build_scene(const std::string& name, const SceneParameters& parameters) {
  for (const SceneEntry& scene : scene_library())
    if (name == scene.name) return scene.build(parameters);
  return tl::unexpected(unknown_scene(name));
}

}  // namespace gvom::sim
