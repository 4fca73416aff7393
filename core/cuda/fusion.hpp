// Half two of the pipeline on a CUDA device.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/backend.hpp"
#include "core/cuda/brick_writer.hpp"
#include "core/cuda/fused_map.hpp"
#include "core/cuda/layer_maker.hpp"
#include "core/cuda/map_ring.hpp"

namespace gvom::cuda {

class Fusion : public FusionBackend {
 public:
  /// Takes all memory; whether that went well, `device` says.
  /// @param in_place see MapRing
  Fusion(std::unique_ptr<Device> device, const FusionSetup& setup, bool in_place);

  DeviceExpected<AddResult> add(const WindowMap& map) override;
  DeviceExpected<void> make_layers(const LayerArrays& out) override;
  DeviceExpected<BrickMapShape> count_voxels() override;
  DeviceExpected<void> write_voxels(const BrickMapArrays& out) override;
  void reset() override;
  [[nodiscard]] const Window& window() const override { return window_; }
  [[nodiscard]] std::optional<DeviceCosts> last_costs() const override;
  std::vector<KernelTime> take_kernel_times() override { return device_->take_kernel_times(); }

 private:
  DeviceExpected<void> settle();

  std::unique_ptr<Device> device_;
  bool in_place_;
  Window window_;
  MapRing ring_;
  FusedMap map_;
  LayerMaker layer_maker_;
  BrickWriter voxel_writer_;
  std::vector<std::uint32_t> unsettled_;  // places whose maps the device may still be reading
  std::uint64_t add_launches_ = 0;
  std::uint64_t layer_launches_ = 0;
};

}  // namespace gvom::cuda
