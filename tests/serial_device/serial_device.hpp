// What the serial device can be told to be.
#pragma once

#include <cstdint>

namespace gvom::cuda::serial {

/// The next devices share the host's memory, as integrated GPUs do.
void share_host_memory(bool shares);
/// The next devices refuse to pin memory.
void refuse_to_pin(bool refuses);
/// From its `operation`-th operation (upload, download, clear, kernel, 1 is the first) on, every device that
/// is open or will be fails for good, as after a fault in a kernel; 0: never. At the start of a program it is
/// the environment's GVOM_SERIAL_DEVICE_FAIL_AT.
void fail_at(std::uint64_t operation);
/// Memory that devices have been asked for so far, times.
std::uint64_t allocations();
/// Times that somebody waited for a device.
std::uint64_t waits();

}  // namespace gvom::cuda::serial
