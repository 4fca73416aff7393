#include "tools/sim/scene_library.hpp"

#include "tools/sim/scenes/trail.hpp"

namespace gvom::sim {

const std::vector<SceneEntry>& scene_library() {
  static const std::vector<SceneEntry> entries{
      {"trail", "woods along a trail, with a ditch, a step, a branch and a person", make_trail}};
  return entries;
}

tl::expected<WorldData, std::string> build_scene(const std::string& name, const SceneParameters& parameters) {
  for (const SceneEntry& entry : scene_library())
    if (name == entry.name) return entry.build(parameters);
  return tl::unexpected(name + ": no such scene; there is trail");
}

}  // namespace gvom::sim
