// Threads that work as one warp: 32 lanes that see each other's values.
//
// A warp's functor is written once, in steps that all lanes do (`for_each_lane`) and votes between them. On a
// device each thread is one lane; on the host, where the tests run kernels, one thread does the lanes one
// after the other, and `PerLane` holds the values of all. What lies outside of a step is the same for all
// lanes.
#pragma once

#include <cuda_runtime.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace gvom::cuda {

inline constexpr std::int32_t kLanes = 32;

/// The lowest set bit of a vote that is not 0.
__device__ inline std::int32_t lowest_lane(std::uint32_t vote) {
  return __ffs(static_cast<int>(vote)) - 1;
}

__device__ inline std::uint32_t count_lanes(std::uint32_t vote) {
  return static_cast<std::uint32_t>(__popc(vote));
}

/// How many lanes before this one voted.
__device__ inline std::uint32_t lanes_before(std::uint32_t vote, std::int32_t lane) {
  return count_lanes(vote & ((1U << lane) - 1));
}

#ifdef __CUDACC__

/// A value of each lane. `lane` is the one that asks.
template <class T>
class PerLane {
 public:
  __device__ T& operator[](std::int32_t /*lane*/) { return mine_; }
  __device__ const T& operator[](std::int32_t /*lane*/) const { return mine_; }

 private:
  T mine_{};
};

/// Whether this thread of the kernel calls a warp's functor.
__device__ inline bool calls_for_warp() {
  return true;
}

template <class Step>
__device__ void for_each_lane(Step&& step) {
  step(static_cast<std::int32_t>(threadIdx.x) % kLanes);
}

/// A step of one lane alone.
template <class Step>
__device__ void in_lane(std::int32_t lane, Step&& step) {
  if (static_cast<std::int32_t>(threadIdx.x) % kLanes == lane) step();
}

/// Bit `lane`: what `holds(lane)` says.
template <class Holds>
__device__ std::uint32_t vote(Holds&& holds) {
  return __ballot_sync(~0U, holds(static_cast<std::int32_t>(threadIdx.x) % kLanes));
}

/// The value of one lane, for all.
template <class T>
__device__ T of_lane(const PerLane<T>& values, std::int32_t lane) {
  return __shfl_sync(~0U, values[lane], lane);
}
template <class T>
__device__ T* of_lane(const PerLane<T*>& pointers, std::int32_t lane) {
  return reinterpret_cast<T*>(__shfl_sync(~0U, reinterpret_cast<unsigned long long>(pointers[lane]), lane));
}

/// The lowest of what `value(lane)` says, never NaN or -0.
template <class Value>
__device__ float lowest_of_lanes(Value&& value) {
  float lowest = value(static_cast<std::int32_t>(threadIdx.x) % kLanes);
  for (std::int32_t apart = kLanes / 2; apart > 0; apart /= 2) {
    const float other = __shfl_xor_sync(~0U, lowest, apart);
    lowest = other < lowest ? other : lowest;
  }
  return lowest;
}

/// The highest of what `value(lane)` says.
template <class Value>
__device__ std::int32_t highest_of_lanes(Value&& value) {
  std::int32_t highest = value(static_cast<std::int32_t>(threadIdx.x) % kLanes);
  for (std::int32_t apart = kLanes / 2; apart > 0; apart /= 2) {
    const std::int32_t other = __shfl_xor_sync(~0U, highest, apart);
    highest = other > highest ? other : highest;
  }
  return highest;
}

/// All bits that are set in what any `value(lane)` says.
template <class Value>
__device__ std::uint64_t bits_of_lanes(Value&& value) {
  std::uint64_t bits = value(static_cast<std::int32_t>(threadIdx.x) % kLanes);
  for (std::int32_t apart = kLanes / 2; apart > 0; apart /= 2)
    bits |= __shfl_xor_sync(~0U, static_cast<unsigned long long>(bits), apart);
  return bits;
}

#else

template <class T>
class PerLane {
 public:
  T& operator[](std::int32_t lane) { return all_[static_cast<std::size_t>(lane)]; }
  const T& operator[](std::int32_t lane) const { return all_[static_cast<std::size_t>(lane)]; }

 private:
  std::array<T, kLanes> all_{};
};

inline bool calls_for_warp() {
  return threadIdx.x % kLanes == 0;
}

/// As if this thread were another of its warp.
class AsLane {
 public:
  explicit AsLane(std::int32_t lane) : own_(threadIdx.x) {
    now() = own_ / kLanes * kLanes + static_cast<unsigned>(lane);
  }
  ~AsLane() { now() = own_; }
  AsLane(const AsLane&) = delete;
  AsLane& operator=(const AsLane&) = delete;

 private:
  // Volatile: who observes accesses to memory looks at it in between.
  static volatile unsigned& now() { return threadIdx.x; }

  unsigned own_;
};

template <class Step>
void in_lane(std::int32_t lane, Step&& step) {
  const AsLane as(lane);
  step();
}

template <class Step>
void for_each_lane(Step&& step) {
  for (std::int32_t lane = 0; lane < kLanes; ++lane) in_lane(lane, [&] { step(lane); });
}

template <class Holds>
std::uint32_t vote(Holds&& holds) {
  std::uint32_t bits = 0;
  for_each_lane([&](std::int32_t lane) { bits |= static_cast<std::uint32_t>(holds(lane)) << lane; });
  return bits;
}

template <class T>
T of_lane(const PerLane<T>& values, std::int32_t lane) {
  return values[lane];
}

template <class Value>
float lowest_of_lanes(Value&& value) {
  float lowest = value(0);
  for_each_lane([&](std::int32_t lane) {
    const float other = value(lane);
    lowest = other < lowest ? other : lowest;
  });
  return lowest;
}

template <class Value>
std::int32_t highest_of_lanes(Value&& value) {
  std::int32_t highest = value(0);
  for_each_lane([&](std::int32_t lane) {
    const std::int32_t other = value(lane);
    highest = other > highest ? other : highest;
  });
  return highest;
}

template <class Value>
std::uint64_t bits_of_lanes(Value&& value) {
  std::uint64_t bits = 0;
  for_each_lane([&](std::int32_t lane) { bits |= value(lane); });
  return bits;
}

#endif

}  // namespace gvom::cuda
