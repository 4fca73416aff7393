// The fake runtime refuses what the real one refuses, and tells what the real one would not.
#include <cuda_runtime.h>

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/fake_cuda/fake_cuda.hpp"

namespace fake_cuda {
namespace {

struct Runtime {
  Runtime() {
    throw_findings(true);
    REQUIRE(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess);
    REQUIRE(cudaMalloc(&memory, 64) == cudaSuccess);
  }
  ~Runtime() {
    cudaFree(memory);
    cudaStreamDestroy(stream);
    throw_findings(false);
  }
  cudaError_t end_capture() {
    cudaGraph_t graph = nullptr;
    const cudaError_t error = cudaStreamEndCapture(stream, &graph);
    if (graph != nullptr) cudaGraphDestroy(graph);
    return error;
  }

  cudaStream_t stream = nullptr;
  void* memory = nullptr;
};

TEST_CASE("in a capture nothing is allocated and nothing that is not pinned is copied") {
  Runtime r;
  void* more = nullptr;
  REQUIRE(cudaStreamBeginCapture(r.stream, cudaStreamCaptureModeThreadLocal) == cudaSuccess);
  CHECK(cudaMalloc(&more, 8) == cudaErrorStreamCaptureUnsupported);
  CHECK(r.end_capture() == cudaErrorStreamCaptureInvalidated);

  int here = 5;
  REQUIRE(cudaStreamBeginCapture(r.stream, cudaStreamCaptureModeThreadLocal) == cudaSuccess);
  CHECK(cudaMemcpyAsync(r.memory, &here, sizeof here, cudaMemcpyHostToDevice, r.stream) ==
        cudaErrorStreamCaptureUnsupported);
  CHECK(r.end_capture() == cudaErrorStreamCaptureInvalidated);

  REQUIRE(cudaStreamBeginCapture(r.stream, cudaStreamCaptureModeThreadLocal) == cudaSuccess);
  CHECK(cudaMemsetAsync(r.memory, 0, 64, r.stream) == cudaSuccess);
  CHECK(r.end_capture() == cudaSuccess);
}

TEST_CASE("work is done when it is waited for; pageable memory is read at once, pinned memory then") {
  Runtime r;
  void* pinned = nullptr;
  REQUIRE(cudaMallocHost(&pinned, sizeof(int)) == cudaSuccess);
  int& sent = *static_cast<int*>(pinned);
  int pageable = 1;
  sent = 1;
  int* const there = static_cast<int*>(r.memory);
  cudaMemcpyAsync(there, &sent, sizeof sent, cudaMemcpyHostToDevice, r.stream);
  cudaMemcpyAsync(there + 1, &pageable, sizeof pageable, cudaMemcpyHostToDevice, r.stream);
  sent = pageable = 2;
  CHECK(there[0] != 2);
  REQUIRE(cudaStreamSynchronize(r.stream) == cudaSuccess);
  CHECK(there[0] == 2);
  CHECK(there[1] == 1);
  cudaFreeHost(pinned);
}

TEST_CASE("what would corrupt memory, or wait for another stream, is a finding") {
  Runtime r;
  std::vector<char> host(128);
  cudaStream_t blocking = nullptr;
  CHECK_THROWS_AS(cudaStreamCreateWithFlags(&blocking, cudaStreamDefault), std::logic_error);
  CHECK_THROWS_AS(cudaMemcpyAsync(r.memory, host.data(), 65, cudaMemcpyHostToDevice, r.stream),
                  std::logic_error);
  CHECK_THROWS_AS(cudaMemcpyAsync(host.data(), r.memory, 65, cudaMemcpyDeviceToHost, r.stream),
                  std::logic_error);
  CHECK_THROWS_AS(cudaMemsetAsync(host.data(), 0, 1, r.stream), std::logic_error);
  CHECK_THROWS_AS(cudaMemsetAsync(r.memory, 0, 1, nullptr), std::logic_error);
  REQUIRE(cudaHostRegister(host.data(), 64, cudaHostRegisterPortable) == cudaSuccess);
  CHECK_THROWS_AS(cudaMemcpyAsync(r.memory, host.data() + 32, 64, cudaMemcpyHostToDevice, r.stream),
                  std::logic_error);
  CHECK(cudaHostRegister(host.data() + 32, 64, cudaHostRegisterPortable) ==
        cudaErrorHostMemoryAlreadyRegistered);
  CHECK(cudaHostUnregister(host.data()) == cudaSuccess);
  CHECK_THROWS_AS(cudaFreeHost(r.memory), std::logic_error);
}

TEST_CASE("an error of a kernel stays, and what is left over is told") {
  Runtime r;
  CHECK(leftovers() == "1 pieces of device memory; 1 streams; ");
  fake_cuda::fail_at(1);
  cudaMemsetAsync(r.memory, 0, 1, r.stream);
  CHECK(cudaStreamSynchronize(r.stream) == cudaErrorIllegalAddress);
  CHECK(cudaGetLastError() == cudaErrorIllegalAddress);
  CHECK(cudaGetLastError() == cudaErrorIllegalAddress);
  void* more = nullptr;
  CHECK(cudaMalloc(&more, 8) == cudaErrorIllegalAddress);
  fake_cuda::fail_at(0);
}

}  // namespace
}  // namespace fake_cuda
