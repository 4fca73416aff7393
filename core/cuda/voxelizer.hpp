// Half one of the pipeline on a CUDA device: from the returns of a sweep to a buffer map (R2..R6).
#pragma once

#include <memory>
#include <vector>

#include "core/backend.hpp"
#include "core/cuda/brick_writer.hpp"
#include "core/cuda/device.hpp"
#include "core/cuda/return_kernels.hpp"
#include "core/open_backend.hpp"

namespace gvom::cuda {

class Voxelizer : public VoxelizerBackend {
 public:
  /// Takes all memory; whether that went well, `device` says.
  Voxelizer(std::unique_ptr<Device> device, const VoxelizerSetup& setup);

  DeviceExpected<BrickMapShape> count(const Sweep& sweep, const std::vector<Pose>& T_odom_base,
                                      const Grid& grid) override;
  DeviceExpected<void> write(const BrickMapArrays& out) override;
  [[nodiscard]] const FilterCounts& filter_counts() const override { return filter_counts_; }
  std::vector<KernelTime> take_kernel_times() override { return device_->take_kernel_times(); }

 private:
  void forget();
  void make_room_for_poses(std::size_t count);
  void send_poses(const std::vector<Pose>& T_odom_base, const Grid& grid);
  void cast(const Sweep& sweep, const Grid& grid);

  std::unique_ptr<Device> device_;
  Eigen::Isometry3d T_base_sensor_;
  ReturnFilter filter_;
  std::size_t most_returns_;
  std::uint32_t slots_;
  Grid grid_;  // of the sweep
  DenseBricks bricks_;
  std::uint8_t* touched_;
  std::int32_t* lowest_;  // of SweepCounters
  std::uint32_t* verdicts_;
  std::uint32_t* verdicts_here_;  // pinned
  Return* returns_;
  Return* staged_returns_;  // pinned
  std::size_t most_poses_ = 0;
  SensorPose* poses_ = nullptr;
  SensorPose* staged_poses_ = nullptr;  // pinned
  BrickWriter writer_;
  FilterCounts filter_counts_;
};

}  // namespace gvom::cuda
