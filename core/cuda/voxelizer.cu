#include "core/cuda/voxelizer.hpp"

#include <algorithm>

#include "core/cuda/fill.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/lowest_ray_kernels.hpp"

namespace gvom::cuda {

namespace {

constexpr std::int32_t kColumns = kBrickEdge * kBrickEdge;
constexpr std::size_t kUsualPoses = 4096;
// Returns that are sent at a time: while the device works on them the next are copied to where it fetches
// them.
constexpr std::size_t kBatch = 16384;

}  // namespace

Voxelizer::Voxelizer(std::unique_ptr<Device> device, const VoxelizerSetup& setup)
    : device_(std::move(device)),
      T_base_sensor_(setup.lidar.T_base_sensor),
      filter_(setup.lidar, setup.vehicle),
      most_returns_(std::max<std::size_t>(setup.max_returns, 1)),
      slots_(grid_around(setup.map, Eigen::Vector3d::Zero()).brick_slots()),
      grid_(grid_around(setup.map, Eigen::Vector3d::Zero())),
      bricks_{grid_around(setup.map, Eigen::Vector3d::Zero()).bricks(),
              device_->array<std::uint32_t>(std::size_t{slots_} * kBrickCells),
              device_->array<std::uint32_t>(std::size_t{slots_} * kBrickCells),
              device_->array<float>(std::size_t{slots_} * kBrickCells)},
      touched_(device_->array<std::uint8_t>(slots_)),
      lowest_(device_->array<std::int32_t>(grid_.columns())),
      verdicts_(device_->array<std::uint32_t>(kVerdicts)),
      verdicts_here_(device_->pinned_array<std::uint32_t>(kVerdicts)),
      returns_(device_->array<Return>(most_returns_)),
      staged_returns_(device_->pinned_array<Return>(most_returns_)),
      writer_(*device_, setup.map, most_returns_) {
  make_room_for_poses(kUsualPoses);
  device_->clear(bricks_.hits, std::size_t{slots_} * kBrickCells * sizeof *bricks_.hits);
  device_->clear(bricks_.passes, std::size_t{slots_} * kBrickCells * sizeof *bricks_.passes);
  device_->clear(touched_, slots_);
  for_each(*device_, static_cast<std::int32_t>(slots_ * kBrickCells),
           Fill<float>{bricks_.min_height_m, kNoHeight_m});
}

// Empties the counters of the last sweep.
void Voxelizer::forget() {
  for_each(*device_, static_cast<std::int32_t>(slots_) * kColumns, ClearTouched{bricks_, touched_});
  device_->clear(touched_, slots_);
  for_each(*device_, static_cast<std::int32_t>(grid_.columns()), Fill<std::int32_t>{lowest_, kNoRay});
}

void Voxelizer::make_room_for_poses(std::size_t count) {
  most_poses_ = count;
  poses_ = device_->array<SensorPose>(count);
  staged_poses_ = device_->pinned_array<SensorPose>(count);
}

DeviceExpected<BrickMapShape> Voxelizer::count(const Sweep& sweep, const std::vector<Pose>& T_odom_base,
                                               const Grid& grid) {
  if (device_->failed()) return tl::make_unexpected(device_->failure());
  forget();
  grid_ = grid;
  device_->clear(verdicts_, kVerdicts * sizeof *verdicts_);
  send_poses(T_odom_base, grid);
  cast(sweep, grid);
  // The dense bricks lie from the grid's origin on: as those of a grid whose origin is 0.
  Grid from_zero = grid;
  from_zero.origin = {0, 0, 0};
  writer_.measure(bricks_, from_zero);
  device_->download(verdicts_here_, verdicts_, kVerdicts * sizeof *verdicts_);
  if (const auto done = device_->wait(); !done) return tl::make_unexpected(done.error());
  const auto counted = [this](Verdict v) { return verdicts_here_[static_cast<std::uint32_t>(v)]; };
  filter_counts_ = {counted(Verdict::used), counted(Verdict::not_finite), counted(Verdict::too_near),
                    counted(Verdict::too_far), counted(Verdict::body)};
  return writer_.shape();
}

void Voxelizer::send_poses(const std::vector<Pose>& T_odom_base, const Grid& grid) {
  if (T_odom_base.size() > most_poses_)  // rare: more times than any sweep before
    make_room_for_poses(std::max(2 * most_poses_, T_odom_base.size()));
  if (device_->failed()) return;
  for (std::size_t i = 0; i < T_odom_base.size(); ++i) {
    SensorPose& pose = staged_poses_[i];
    pose.T_odom_sensor = sensor_in_odom(T_odom_base[i], T_base_sensor_);
    for (std::size_t a = 0; a < 3; ++a)
      pose.from[a] = fixed_in_grid(pose.T_odom_sensor.t[a], grid.resolution_m[a], grid.origin[a]);
  }
  device_->upload(poses_, staged_poses_, T_odom_base.size() * sizeof *poses_);
}

// Out of pinned memory, batch by batch. A sweep may have more returns than there is room for: then the device
// must have read the first ones before others take their place.
void Voxelizer::cast(const Sweep& sweep, const Grid& grid) {
  std::size_t room = 0;
  for (std::size_t first = 0; first < sweep.returns.size();) {
    if (room == most_returns_) {
      static_cast<void>(device_->wait());
      room = 0;
    }
    if (device_->failed()) return;
    const std::size_t count = std::min({kBatch, most_returns_ - room, sweep.returns.size() - first});
    std::copy_n(sweep.returns.data() + first, count, staged_returns_ + room);
    device_->upload(returns_ + room, staged_returns_ + room, count * sizeof *returns_);
    for_each(*device_, static_cast<std::int32_t>(count),
             CastReturn{{grid, bricks_, touched_, verdicts_, lowest_}, filter_, returns_ + room, poses_});
    first += count;
    room += count;
  }
}

DeviceExpected<void> Voxelizer::write(const BrickMapArrays& out) {
  for_each(*device_, static_cast<std::int32_t>(grid_.columns()),
           MeasureRays{lowest_, grid_.origin[2], grid_.resolution_m[2], writer_.lowest_ray_m()});
  writer_.write(out);
  return device_->wait();
}

}  // namespace gvom::cuda
