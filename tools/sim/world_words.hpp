// The words that files use for what is in a world.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// In the order of `Kind`.
inline constexpr std::array<std::string_view, 9> kKindWords{"tree", "bush",   "grass",  "rock", "wall",
                                                            "car",  "branch", "walker", "dust"};
/// In the order of `Body::Shape`.
inline constexpr std::array<std::string_view, 3> kShapeWords{"ellipsoid", "capsule", "box"};

inline std::string_view word_of(Kind kind) {
  return kKindWords[static_cast<std::size_t>(kind)];
}
inline std::string_view word_of(Body::Shape shape) {
  return kShapeWords[static_cast<std::size_t>(shape)];
}

}  // namespace gvom::sim
