#include "tests/oracle/left.hpp"

#include <algorithm>
#include <tuple>

namespace gvom::oracle {

namespace {

// As the voxels of a map are in order.
std::tuple<int, int, int> rank(const Int3& world) {
  return {world[1], world[0], world[2]};
}

Voxel voxel_in(const BufferMap& map, const Int3& world) {
  const auto found =
      std::lower_bound(map.observed.begin(), map.observed.end(), world,
                       [](const WorldVoxel& one, const Int3& at) { return rank(one.at) < rank(at); });
  return found != map.observed.end() && found->at == world ? found->voxel : Voxel{};
}

}  // namespace

bool Leaving::hit_within(const Int3& world, std::int64_t age_ns) const {
  return std::any_of(window_.begin(), window_.end(), [&](const BufferMap* map) {
    return window_.front()->stamp_ns - map->stamp_ns < age_ns && voxel_in(*map, world).hits > 0;
  });
}

bool Leaving::hit_just_now_around(const Int3& world) const {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      if (hit_within({world[0] + dx, world[1] + dy, world[2]}, 80'000'000)) return true;
  return false;
}

bool Leaving::passed(const Int3& world, const Voxel& voxel) const {
  std::int64_t hit_ns = window_.front()->stamp_ns - 1'000'000'000;
  for (const BufferMap* map : window_)
    if (voxel_in(*map, world).hits > 0) hit_ns = std::max(hit_ns, map->stamp_ns);
  std::uint64_t passes = 0;
  std::int64_t passed_ns = 0;  // by the newest map
  for (const BufferMap* map : window_) {
    if (map->stamp_ns <= hit_ns) break;
    const Voxel one = voxel_in(*map, world);
    if (passes == 0 && one.passes > 0) passed_ns = map->stamp_ns;
    passes += one.passes;
  }
  if (passes == 0 || passed_ns - hit_ns < 180'000'000) return false;
  const std::uint64_t before = std::uint64_t{voxel.hits} + voxel.passes - passes;
  if (passes * voxel.hits >= 16 * before) return true;
  return passes * voxel.hits >= 4 * before && !hit_just_now_around(world);
}

}  // namespace gvom::oracle
