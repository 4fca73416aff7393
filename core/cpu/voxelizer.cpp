#include "core/cpu/voxelizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/cpu/clones.hpp"
#include "core/ray.hpp"

namespace gvom::cpu {

namespace {

// Set in a voxel's pass counter when it has a hit.
constexpr std::uint32_t kOccupied = 0x80000000u;

Grid grid_shape(const MapConfig& map) {
  return grid_around(map, Eigen::Vector3d::Zero());
}

// A rigid transform as plain numbers, so that every machine adds in the same order.
struct Transform {
  double r[3][3];
  double t[3];

  Transform(const Pose& T_odom_base, const Eigen::Isometry3d& T_base_sensor) {
    const Eigen::Matrix3d R = T_odom_base.rotation.toRotationMatrix();
    const Eigen::Matrix3d rotation = R * T_base_sensor.linear();
    const Eigen::Vector3d translation = R * T_base_sensor.translation() + T_odom_base.translation_m;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r[i][j] = rotation(i, j);
      t[i] = translation[i];
    }
  }

  [[nodiscard]] double coordinate(int i, double x, double y, double z) const {
    return ((r[i][0] * x + r[i][1] * y) + r[i][2] * z) + t[i];
  }
};

GVOM_CLONES void place_points(const Transform& T_odom_sensor, const Grid& grid, ReturnBatch& points,
                              RayEnds& ends) {
  for (int i = 0; i < ends.count; ++i) {
    double p[3];
    for (int a = 0; a < 3; ++a) {
      p[a] = T_odom_sensor.coordinate(a, points.x[i], points.y[i], points.z[i]);
      ends.to[a][i] = to_fixed(voxel_coordinate(p[a], grid.resolution_m[a]), grid.origin[a]);
    }
    points.height_m[i] = static_cast<float>(p[2]) + 0.0f;  // -0 and 0 are one height
  }
}

}  // namespace

Voxelizer::Voxelizer(const MapConfig& map, const LidarGeometry& lidar, const VehicleGeometry& vehicle,
                     std::size_t max_returns)
    : lidar_(lidar),
      vehicle_(vehicle),
      brick_slots_(grid_shape(map).brick_slots()),
      passes_(grid_shape(map)),
      hit_of_(std::size_t{brick_slots_} * kBrickCells) {
  hits_.reserve(max_returns);
  bricks_.reserve(brick_slots_);
}

bool Voxelizer::passes_filter(const Return& r, FilterCounts& counts) const {
  if (!std::isfinite(r.x_m) || !std::isfinite(r.y_m) || !std::isfinite(r.z_m))
    return ++counts.not_finite, false;
  const double range_m = std::sqrt((r.x_m * r.x_m + r.y_m * r.y_m) + r.z_m * r.z_m);
  if (range_m < lidar_.min_range_m) return ++counts.too_near, false;
  if (range_m > lidar_.max_range_m) return ++counts.too_far, false;
  if (vehicle_.body) {
    const Eigen::Vector3d p_base = lidar_.T_base_sensor * Eigen::Vector3d(r.x_m, r.y_m, r.z_m);
    const bool in_body = (p_base.array() >= vehicle_.body->min_m.array()).all() &&
                         (p_base.array() <= vehicle_.body->max_m.array()).all();
    if (in_body) return ++counts.body, false;
  }
  return ++counts.used, true;
}

void Voxelizer::add_hit(std::uint32_t index, float height_m) {
  if (index == passes_.outside()) return;
  std::uint32_t& counter = passes_.counters()[index];
  if (!(counter & kOccupied)) {
    counter |= kOccupied;
    passes_.touched()[index >> 9] = 1;
    hit_of_[index] = static_cast<std::uint32_t>(hits_.size());
    hits_.push_back({1, height_m});
    return;
  }
  Hit& hit = hits_[hit_of_[index]];
  ++hit.hits;
  hit.min_height_m = std::min(hit.min_height_m, height_m);
}

const Return* Voxelizer::fill_batch(const Return* r, const Return* end) {
  const std::uint32_t time = r->time_index;
  ends_.count = 0;
  for (; r != end && r->time_index == time && ends_.count < kRayBatch; ++r) {
    if (!passes_filter(*r, filter_counts_)) continue;
    const int i = ends_.count++;
    batch_.x[i] = r->x_m, batch_.y[i] = r->y_m, batch_.z[i] = r->z_m;
  }
  return r;
}

BrickMapShape Voxelizer::count(const Sweep& sweep, const std::vector<Pose>& T_odom_base, const Grid& grid) {
  forget();
  filter_counts_ = {};
  if (sweep.returns.empty()) return {brick_slots_, 0, 0};
  const Return* const end = sweep.returns.data() + sweep.returns.size();
  for (const Return* r = sweep.returns.data(); r != end;) {
    const std::uint32_t time = r->time_index;
    const Transform T_odom_sensor(T_odom_base[time], lidar_.T_base_sensor);
    std::int64_t from[3];
    for (int a = 0; a < 3; ++a)
      from[a] = to_fixed(voxel_coordinate(T_odom_sensor.t[a], grid.resolution_m[a]), grid.origin[a]);
    while (r != end && r->time_index == time) {
      r = fill_batch(r, end);
      if (ends_.count == 0) continue;
      place_points(T_odom_sensor, grid, batch_, ends_);
      for (int i = 0; i < ends_.count; ++i)
        ends_.counter[i] = passes_.index(fixed_voxel(ends_.to[0][i]), fixed_voxel(ends_.to[1][i]),
                                         fixed_voxel(ends_.to[2][i]));
      passes_.cast(from, ends_);
      for (int i = 0; i < ends_.count; ++i) add_hit(ends_.counter[i], batch_.height_m[i]);
    }
  }
  BrickMapShape shape{brick_slots_, 0, static_cast<std::uint32_t>(hits_.size())};
  find_touched_bricks(shape);
  return shape;
}

void Voxelizer::find_touched_bricks(BrickMapShape& shape) {
  std::uint8_t* touched = passes_.touched();
  for (std::uint32_t slot = 0; slot < brick_slots_; ++slot) {
    if (!touched[slot]) continue;
    touched[slot] = 0;
    bricks_.push_back(slot);
  }
  touched[brick_slots_] = 0;
  shape.brick_count = static_cast<std::uint32_t>(bricks_.size());
}

void Voxelizer::write(const BrickMapArrays& out) {
  std::fill_n(out.directory, brick_slots_, -1);
  std::uint32_t record = 0;
  for (std::uint32_t brick = 0; brick < bricks_.size(); ++brick) {
    const std::uint32_t slot = bricks_[brick];
    std::uint32_t* counters = passes_.counters() + std::size_t{slot} * kBrickCells;
    std::int32_t* lookup = out.lookup + std::size_t{brick} * kBrickCells;
    std::uint32_t any = 0;
    std::uint64_t columns = 0;
    for (int column = 0; column < kBrickEdge * kBrickEdge; ++column) {
      std::uint32_t observed = 0;
      for (int i = column * kBrickEdge; i < (column + 1) * kBrickEdge; ++i) {
        observed |= counters[i];
        lookup[i] = free_lookup(counters[i]);
      }
      any |= observed;
      columns |= std::uint64_t{observed != 0} << column;
    }
    if (any & kOccupied) record = write_hits(out, slot, lookup, record);
    out.directory[slot] = static_cast<std::int32_t>(brick);
    out.columns[brick] = columns;
    std::memset(counters, 0, kBrickCells * sizeof *counters);
  }
  bricks_.clear();
  hits_.clear();
}

std::uint32_t Voxelizer::write_hits(const BrickMapArrays& out, std::uint32_t slot, std::int32_t* lookup,
                                    std::uint32_t record) {
  const std::uint32_t* counters = passes_.counters() + std::size_t{slot} * kBrickCells;
  const std::uint32_t* hit_of = hit_of_.data() + std::size_t{slot} * kBrickCells;
  for (int cell = 0; cell < kBrickCells; ++cell) {
    if (!(counters[cell] & kOccupied)) continue;
    const Hit& hit = hits_[hit_of[cell]];
    out.records[record] = {hit.hits, counters[cell] & ~kOccupied, hit.min_height_m};
    lookup[cell] = static_cast<std::int32_t>(record++);
  }
  return record;
}

void Voxelizer::forget() {
  for (const std::uint32_t slot : bricks_)
    std::memset(passes_.counters() + std::size_t{slot} * kBrickCells, 0, kBrickCells * sizeof(std::uint32_t));
  bricks_.clear();
  hits_.clear();
}

}  // namespace gvom::cpu
