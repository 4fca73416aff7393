#include "core/cpu/voxelizer.hpp"

#include <algorithm>
#include <cstring>

#include "core/cpu/clones.hpp"
#include "core/returns.hpp"

namespace gvom::cpu {

namespace {

// Set in a voxel's pass counter when it has a hit.
constexpr std::uint32_t kOccupied = 0x80000000u;

Grid grid_shape(const MapConfig& map) {
  return grid_around(map, Eigen::Vector3d::Zero());
}

GVOM_CLONES void place_points(const RigidTransform& T_odom_sensor, const Grid& grid, ReturnBatch& points,
                              RayEnds& ends) {
  for (int i = 0; i < ends.count; ++i) {
    double p[3];
    for (int a = 0; a < 3; ++a) {
      p[a] = T_odom_sensor.coordinate(a, points.x[i], points.y[i], points.z[i]);
      ends.to[a][i] = fixed_in_grid(p[a], grid.resolution_m[a], grid.origin[a]);
    }
    points.height_m[i] = height_of_return(p[2]);
  }
}

}  // namespace

Voxelizer::Voxelizer(const MapConfig& map, const LidarGeometry& lidar, const VehicleGeometry& vehicle,
                     std::size_t max_returns)
    : T_base_sensor_(lidar.T_base_sensor),
      filter_(lidar, vehicle),
      brick_slots_(grid_shape(map).brick_slots()),
      passes_(grid_shape(map)),
      hit_of_(std::size_t{brick_slots_} * kBrickCells) {
  hits_.reserve(max_returns);
  bricks_.reserve(brick_slots_);
}

bool Voxelizer::passes_filter(const Return& r) {
  switch (filter_.judge(r)) {
    case Verdict::used:
      return ++filter_counts_.used, true;
    case Verdict::not_finite:
      return ++filter_counts_.not_finite, false;
    case Verdict::too_near:
      return ++filter_counts_.too_near, false;
    case Verdict::too_far:
      return ++filter_counts_.too_far, false;
    case Verdict::body:
      break;
  }
  return ++filter_counts_.body, false;
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
    if (!passes_filter(*r)) continue;
    const int i = ends_.count++;
    batch_.x[i] = r->x_m, batch_.y[i] = r->y_m, batch_.z[i] = r->z_m;
  }
  return r;
}

DeviceExpected<BrickMapShape> Voxelizer::count(const Sweep& sweep, const std::vector<Pose>& T_odom_base,
                                               const Grid& grid) {
  forget();
  filter_counts_ = {};
  grid_ = grid;
  BrickMapShape shape{brick_slots_, 0, 0, grid.columns()};
  if (sweep.returns.empty()) return shape;
  const Return* const end = sweep.returns.data() + sweep.returns.size();
  for (const Return* r = sweep.returns.data(); r != end;) {
    const std::uint32_t time = r->time_index;
    const RigidTransform T_odom_sensor = sensor_in_odom(T_odom_base[time], T_base_sensor_);
    std::int64_t from[3];
    for (int a = 0; a < 3; ++a)
      from[a] = fixed_in_grid(T_odom_sensor.t[a], grid.resolution_m[a], grid.origin[a]);
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
  shape.record_count = static_cast<std::uint32_t>(hits_.size());
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

DeviceExpected<void> Voxelizer::write(const BrickMapArrays& out) {
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
  write_lowest_rays(out);
  bricks_.clear();
  hits_.clear();
  return {};
}

GVOM_CLONES void Voxelizer::write_lowest_rays(const BrickMapArrays& out) {
  std::int32_t* lowest = passes_.lowest();
  GVOM_INDEPENDENT
  for (std::uint32_t i = 0; i < grid_.columns(); ++i) {
    out.lowest_ray_m[i] = height_of_ray_m(lowest[i], grid_.origin[2], grid_.resolution_m[2]);
    lowest[i] = kNoRay;
  }
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
  if (!bricks_.empty()) std::fill_n(passes_.lowest(), grid_.columns(), kNoRay);
  bricks_.clear();
  hits_.clear();
}

}  // namespace gvom::cpu
