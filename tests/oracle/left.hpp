// What was left by that which was hit in it (R11), from the text of core/README.md alone.
#pragma once

#include <vector>

#include "tests/oracle/fusion.hpp"

namespace gvom::oracle {

class Leaving {
 public:
  explicit Leaving(const Fusion& fusion) : window_(fusion.window()) {}

  /// Rays pass where something was hit before. @param voxel of the fused map
  [[nodiscard]] bool passed(const Int3& world, const Voxel& voxel) const;
  /// No map of the last 0.18 s hit it.
  [[nodiscard]] bool quiet(const Int3& world) const { return !hit_within(world, 180'000'000); }

 private:
  [[nodiscard]] bool hit_within(const Int3& world, std::int64_t age_ns) const;
  [[nodiscard]] bool hit_just_now_around(const Int3& world) const;

  std::vector<const BufferMap*> window_;  // newest first
};

}  // namespace gvom::oracle
