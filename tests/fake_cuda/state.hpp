// What the fake runtime's files share.
#pragma once

#include <cuda_runtime.h>

#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/fake_cuda/fake_cuda.hpp"

using FakeOperation = std::function<void()>;

struct FakeGraph {
  std::vector<FakeOperation> operations;
};
struct FakePlayable {
  std::vector<FakeOperation> operations;
};
struct FakeEvent {
  bool recorded = false, done = false;
  std::chrono::steady_clock::time_point at;
};
struct FakeStream {
  std::vector<FakeOperation> pending;
  FakeGraph* capture = nullptr;
  bool capture_broken = false;
};

namespace fake_cuda {

using Ranges = std::map<const std::byte*, std::size_t>;

struct State {
  bool shares_host_memory = false, refuses_to_pin = false, throws = false;
  int multiprocessors = 2;
  Absent absent = Absent::nothing;
  Order order = Order::forward;
  Observer* observer = nullptr;
  std::uint64_t failing_operation = 0, refused_in = 0;
  std::string refused;
  Counts counts{};
  cudaError_t last = cudaSuccess, sticky = cudaSuccess;
  Ranges device_memory, pinned, registered;
  std::set<FakeStream*> streams;
  std::set<FakeEvent*> events;
  std::set<FakeGraph*> graphs;
  std::set<FakePlayable*> playables;
};
State& state();

/// Something that the real runtime would not tell, and that must not be.
void finding(const char* call, const std::string& what);

/// Notes an error for cudaGetLastError.
cudaError_t give(cudaError_t error);

enum class InCapture { allowed, breaks };
/// Every call begins here: counts, refuses, and breaks a capture that it may not be part of.
cudaError_t enter(const char* call, InCapture in_capture, cudaError_t refusal = cudaErrorMemoryAllocation);

[[nodiscard]] bool within(const Ranges& ranges, const void* at, std::size_t bytes);
/// Pinned, by the runtime or registered.
[[nodiscard]] bool locked(const void* at, std::size_t bytes);

/// Adds to the stream's work, or to the graph that it captures.
void enqueue(FakeStream* stream, FakeOperation operation);
/// Does what is pending.
void run(FakeStream* stream);
/// A finding unless it is a stream that was made and is still there.
void require_stream(const char* call, FakeStream* stream);

}  // namespace fake_cuda

/// First line of each call of the runtime.
#define FAKE_CUDA_ENTER(...)                                                                       \
  if (const cudaError_t refusal = fake_cuda::enter(__func__, __VA_ARGS__); refusal != cudaSuccess) \
  return refusal
