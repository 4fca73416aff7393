#include "core/ray.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

// The obvious way: every ray is walked voxel by voxel into a dense array.
class StraightLoop {
 public:
  explicit StraightLoop(const Grid& grid) : grid_(grid), passes_(cells(grid)) {}

  void clear(const Grid& grid) {
    grid_ = grid;
    std::fill(passes_.begin(), passes_.end(), 0);
  }

  void count(const Sweep& sweep, const LidarGeometry& lidar, const Pose& T_odom_base) {
    const Eigen::Matrix3d R = T_odom_base.rotation.toRotationMatrix();
    const Eigen::Matrix3d rotation = R * lidar.T_base_sensor.linear();
    const Eigen::Vector3d sensor_m = R * lidar.T_base_sensor.translation() + T_odom_base.translation_m;
    std::int64_t from[3];
    std::int64_t to[3];
    fix(sensor_m, from);
    for (const Return& r : sweep.returns) {
      const double range_m = std::sqrt((r.x_m * r.x_m + r.y_m * r.y_m) + r.z_m * r.z_m);
      if (!(range_m >= lidar.min_range_m && range_m <= lidar.max_range_m)) continue;
      Eigen::Vector3d p_m;
      for (int i = 0; i < 3; ++i)
        p_m[i] = ((rotation(i, 0) * r.x_m + rotation(i, 1) * r.y_m) + rotation(i, 2) * r.z_m) + sensor_m[i];
      fix(p_m, to);
      walk_ray(from, to, [this](std::int32_t x, std::int32_t y, std::int32_t z) {
        if (inside(x, y, z)) ++passes_[index(x, y, z)];
        return true;
      });
    }
  }

  [[nodiscard]] std::uint32_t passes(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return passes_[index(x, y, z)];
  }

 private:
  static std::size_t cells(const Grid& grid) { return std::size_t{grid.brick_slots()} * kBrickCells; }
  void fix(const Eigen::Vector3d& p_m, std::int64_t (&fixed)[3]) const {
    for (int a = 0; a < 3; ++a)
      fixed[a] = to_fixed(voxel_coordinate(p_m[a], grid_.resolution_m[a]), grid_.origin[a]);
  }
  [[nodiscard]] bool inside(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return x >= 0 && x < grid_.size[0] && y >= 0 && y < grid_.size[1] && z >= 0 && z < grid_.size[2];
  }
  [[nodiscard]] std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return static_cast<std::size_t>((x * grid_.size[1] + y) * grid_.size[2] + z);
  }

  Grid grid_;
  std::vector<std::uint32_t> passes_;
};

// Adds up the passes of a map; notes whether each voxel's are those of the straight loop.
void compare(const BrickMapView& map, const StraightLoop& straight, StraightTimes& times) {
  for (std::int32_t x = 0; x < map.grid.size[0]; ++x)
    for (std::int32_t y = 0; y < map.grid.size[1]; ++y)
      for (std::int32_t z = 0; z < map.grid.size[2]; ++z) {
        const Int3& o = map.grid.origin;
        const std::uint32_t passes = map.voxel_at({o[0] + x, o[1] + y, o[2] + z}).passes;
        times.passes += passes;
        times.agree &= passes == straight.passes(x, y, z);
      }
}

}  // namespace

StraightTimes measure_straight(const MapConfig& config, const Recording& recording,
                               const std::vector<OwnedMap>& maps, int repeats) {
  StraightLoop straight(grid_around(config, Eigen::Vector3d::Zero()));
  StraightTimes result;
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t i = 0; i < recording.sweeps.size(); ++i) {
      const Pose& pose = recording.T_odom_base[i];
      straight.clear(grid_around(config, pose.translation_m));
      result.times.add(time_ms([&] { straight.count(recording.sweeps[i], recording.lidar, pose); }));
      if (repeat == 0) compare(maps[i].view, straight, result);
    }
  return result;
}

}  // namespace gvom::bench
