// The device itself, and what it says of errors.
#include <cstring>

#include "tests/fake_cuda/state.hpp"

using namespace fake_cuda;

cudaError_t cudaGetDeviceCount(int* count) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  *count = state().absent == Absent::nothing ? 1 : 0;
  if (state().absent == Absent::nothing) return cudaSuccess;
  return give(state().absent == Absent::device ? cudaErrorNoDevice : cudaErrorInsufficientDriver);
}

cudaError_t cudaDriverGetVersion(int* version) {
  *version = state().absent == Absent::driver ? 0 : state().absent == Absent::new_driver ? 11000 : 13000;
  FAKE_CUDA_ENTER(InCapture::allowed);
  return cudaSuccess;
}

cudaError_t cudaRuntimeGetVersion(int* version) {
  *version = 13000;
  return cudaSuccess;
}

cudaError_t cudaSetDevice(int /*device*/) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  return cudaSuccess;
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int /*device*/) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  *properties = {};
  std::strcpy(properties->name, "fake device on the host");
  properties->multiProcessorCount = state().multiprocessors;
  properties->integrated = state().shares_host_memory ? 1 : 0;
  return cudaSuccess;
}

cudaError_t cudaGetLastError() {
  const cudaError_t was = state().last;
  state().last = state().sticky;
  return was;
}

const char* cudaGetErrorString(cudaError_t error) {
  switch (error) {
    case cudaErrorIllegalAddress:
      return "an illegal memory access was encountered";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorLaunchOutOfResources:
      return "too many resources requested for launch";
    case cudaErrorInsufficientDriver:
      return "CUDA driver version is insufficient for CUDA runtime version";
    case cudaErrorNoDevice:
      return "no CUDA-capable device is detected";
    case cudaErrorNotSupported:
      return "operation not supported";
    case cudaErrorStreamCaptureUnsupported:
      return "operation not permitted when stream is capturing";
    case cudaErrorStreamCaptureInvalidated:
      return "operation failed due to a previous error during capture";
    default:
      return "an error of the fake device";
  }
}
