// What the fake CUDA runtime can be told, and what it has seen. It is as strict as the real one is silent:
// what would corrupt or race there ends the program here, with words on stderr (a finding).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fake_cuda {

/// The device that the next to open find.
void share_host_memory(bool shares);  ///< As integrated GPUs do.
void refuse_to_pin(bool refuses);     ///< cudaHostRegister says "not supported".
void set_multiprocessors(int count);  ///< 2 unless told.
/// What cudaGetDeviceCount says: no driver, one that is too old, no device.
enum class Absent { nothing, driver, new_driver, device };
void lack(Absent what);

/// In which order a kernel's threads run. `threads`: on four of the host's, dealt by hash, for
/// ThreadSanitizer.
enum class Order { forward, reverse, shuffled, threads };
void set_order(Order order);

/// From the `operation`-th operation of a stream on (copy, clear, kernel; 1 is the next) all calls fail for
/// good, as after a fault in a kernel; 0: never, and what failed is well again. At a program's start it is
/// the environment's GVOM_SERIAL_DEVICE_FAIL_AT.
void fail_at(std::uint64_t operation);
/// The `call`-th call from now on (1 is the next) is refused, once: with "out of memory", a launch with "too
/// many resources requested"; 0: none.
void refuse_call(std::uint64_t call);
/// The name of the call that was refused; empty if none was yet.
std::string refused_call();

/// Since the program's start.
struct Counts {
  std::uint64_t allocations;  ///< Of device and of pinned memory.
  std::uint64_t waits;        ///< cudaStreamSynchronize.
  std::uint64_t pageable_uploads;
};
Counts counts();

/// What was made and is still there, in words; empty if nothing.
std::string leftovers();

/// Device memory that is there now, bytes.
std::size_t device_bytes();

/// Hears of all that kernels do, in the order forward.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void kernel(const char* type) = 0;  ///< One begins; see fake_cuda::launch.
  virtual void block() = 0;                   ///< One begins, of that kernel.
};
/// Null: nobody.
void set_observer(Observer* observer);

/// Whether a byte of device memory is there.
bool is_device_memory(const void* at);

/// Findings are thrown as std::logic_error instead of ending the program: for the tests of this runtime.
void throw_findings(bool throws);

}  // namespace fake_cuda
