#include "core/cuda/scan.hpp"

#include <cub/device/device_scan.cuh>

namespace gvom::cuda {

Scan::Scan(Device& device, std::size_t count) : device_(device), count_(count) {
  if (device.failed()) return;
  const std::uint64_t* values = nullptr;
  std::uint64_t* starts = nullptr;
  device.note_launch(cub::DeviceScan::ExclusiveSum(nullptr, scratch_bytes_, values, starts, count), 0);
  scratch_ = device.allocate(scratch_bytes_);
}

void Scan::exclusive_sum(const std::uint64_t* values, std::uint64_t* starts) {
  if (device_.failed()) return;
  device_.begin_kernel("running sum");
  device_.note_launch(cub::DeviceScan::ExclusiveSum(scratch_, scratch_bytes_, values, starts, count_,
                                                    static_cast<cudaStream_t>(device_.stream())),
                      2);
}

}  // namespace gvom::cuda
