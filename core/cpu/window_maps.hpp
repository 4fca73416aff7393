// The window's maps as `presence` reads them (R11).
#pragma once

#include <array>

#include "core/window.hpp"

namespace gvom::cpu {

/// Keeps where the bricks of a stack lie in the newest maps: neighbouring voxels ask for the same.
class WindowMaps {
 public:
  explicit WindowMaps(const Window& window) : maps_(window.maps()) {}

  [[nodiscard]] std::int32_t count() const { return static_cast<std::int32_t>(maps_.size()); }
  [[nodiscard]] std::int64_t stamp_ns(std::int32_t i) const { return view(i).stamp_ns; }
  [[nodiscard]] std::int32_t lookup(std::int32_t i, const Int3& world) const {
    if (i >= kKept) return lookup_at(view(i), world);
    const Int3 brick = brick_of(world);
    Kept& kept = kept_[static_cast<std::size_t>(brick[2]) % kept_.size()];
    if (kept.known == 0 || kept.brick != brick) kept.brick = brick, kept.known = 0;
    for (; kept.known <= i; ++kept.known) {
      const std::int32_t index = view(kept.known).brick_at(brick);
      kept.lookup[static_cast<std::size_t>(kept.known)] =
          index < 0 ? nullptr : view(kept.known).lookup_of(index);
    }
    const std::int32_t* const lookup = kept.lookup[static_cast<std::size_t>(i)];
    return lookup == nullptr ? free_lookup(0) : lookup[cell_in_brick(world[0], world[1], world[2])];
  }

 private:
  static constexpr std::int32_t kKept = 32;  // maps

  struct Kept {
    Int3 brick;
    std::int32_t known = 0;
    std::array<const std::int32_t*, kKept> lookup;
  };

  [[nodiscard]] const BrickMapView& view(std::int32_t i) const {
    return maps_[static_cast<std::size_t>(i)].view;
  }

  const std::vector<WindowMap>& maps_;
  mutable std::array<Kept, 32> kept_;  // by a brick's height, modulo: a stack has no more
};

}  // namespace gvom::cpu
