// Running sums on the device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/device.hpp"

namespace gvom::cuda {

/// `starts[i] = values[0] + ... + values[i - 1]`, over arrays of one length. Memory is taken at construction.
class Scan {
 public:
  Scan(Device& device, std::size_t count);
  void exclusive_sum(const std::uint64_t* values, std::uint64_t* starts);

 private:
  Device& device_;
  std::size_t count_;
  std::size_t scratch_bytes_ = 0;
  void* scratch_ = nullptr;
};

}  // namespace gvom::cuda
