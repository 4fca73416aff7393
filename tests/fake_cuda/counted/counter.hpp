// Counts what kernels read and write of the device's memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fake_cuda {

struct KernelTraffic {
  std::string name;
  std::uint64_t read_bytes = 0;
  std::uint64_t written_bytes = 0;
  std::uint64_t busiest_loads = 0;  ///< Reads of the thread that reads most often.
};

/// From now on, until `take_traffic`. The back end must be compiled with the counting hooks.
void count_traffic();
/// Of each kernel since then, in order. Counting ends.
std::vector<KernelTraffic> take_traffic();

}  // namespace fake_cuda
