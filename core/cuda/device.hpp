// A CUDA device: its memory, and one stream of work that it does in order.
//
// A call that the device refuses is remembered, everything after it does nothing, and `wait` says what it
// was: so work is described in a straight line and errors are looked at where the results are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/open_backend.hpp"

namespace gvom::cuda {

struct DeviceInfo {
  std::string name;        ///< As the driver says it.
  int compute_capability;  ///< Ten times major plus minor.
  int driver_version;      ///< The CUDA version that the driver speaks: 13020 is 13.2.
  int multiprocessors;
  bool shares_host_memory;  ///< An integrated GPU: what the host pins, it reads in place.
};

class Device {
 public:
  /// The first device, with a context and a stream. Errors: none is there, or it does not start.
  static DeviceExpected<std::unique_ptr<Device>> open();
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const DeviceInfo& info() const;

  /// Memory of the device, 256-byte aligned, that holds anything at first; it goes with this object. Null
  /// after a failure.
  void* allocate(std::size_t bytes);
  /// Gives some of it back before that; no work on it may be under way. Nothing happens to null.
  void release(void* memory);
  /// Memory of the host that the device copies from and to without help; it goes with this object too, and
  /// holds anything at first.
  void* allocate_pinned(std::size_t bytes);
  template <class T>
  T* array(std::size_t count) {
    return static_cast<T*>(allocate(count * sizeof(T)));
  }
  template <class T>
  T* pinned_array(std::size_t count) {
    return static_cast<T*>(allocate_pinned(count * sizeof(T)));
  }

  /// Pins memory of the host for as long as this object lives, so that copies out of it and into it are the
  /// device's own. Error: the system refuses; copies go through the driver's staging memory then. No failure
  /// of the device.
  DeviceExpected<void> pin(const HostMemory& memory);
  /// Where the device reads pinned memory in place; null if it does not share the host's memory.
  [[nodiscard]] const void* in_place(const void* host) const;

  /// Work, in order. Host memory must stay as it is until `wait`.
  void upload(void* to, const void* from, std::size_t bytes);
  void download(void* to, const void* from, std::size_t bytes);
  void copy(void* to, const void* from, std::size_t bytes);  ///< Within the device.
  void clear(void* begin, std::size_t bytes);                ///< To zero.

  /// Work that is described once and repeated at a single call. Values are taken when it is described: what
  /// changes from one time to the next must lie in the device's memory.
  using Graph = std::size_t;
  /// @param describe may be called again later: what it refers to must live as long as this object
  Graph record(const std::function<void()>& describe);
  void play(Graph graph);

  /// Notes the moment at which the work so far is done, 0 .. kMoments - 1. The later note counts.
  static constexpr int kMoments = 8;
  void mark(int moment);
  /// After `wait`. 0 where one of them was never noted.
  [[nodiscard]] double ms_between(int earlier, int later) const;

  /// Until all work is done. From the first error on, that error.
  DeviceExpected<void> wait();
  /// Fails for a reason that is not the device's.
  void fail(const std::string& what);
  [[nodiscard]] bool failed() const;
  /// The first error; only after a failure.
  [[nodiscard]] DeviceError failure() const;

  /// Kernels so far, those of graphs too.
  [[nodiscard]] std::uint64_t launches() const;

  /// From now on the device notes how long each kernel takes. Graphs that are recorded later are then played
  /// kernel by kernel, so a tick takes longer: for benchmarks.
  void time_kernels();
  /// Of each kernel since the last call, in order; after `wait`.
  std::vector<KernelTime> take_kernel_times();

  // For core/cuda/launch.hpp and core/cuda/scan.hpp.
  [[nodiscard]] void* stream() const;
  /// Before a launch. `type` is the name of a type as typeid tells it.
  void begin_kernel(const char* type);
  /// After it, with the runtime's answer, and how many kernels it was.
  void note_launch(int error, int kernels = 1);

 private:
  struct State;
  explicit Device(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gvom::cuda
