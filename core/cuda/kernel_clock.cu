#include "core/cuda/kernel_clock.hpp"

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <utility>

namespace gvom::cuda {

namespace {

// "gvom::cuda::UpdateBricks" becomes "UpdateBricks".
std::string plain_name(const char* type) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(abi::__cxa_demangle(type, nullptr, nullptr, &status),
                                                         &std::free);
  const std::string whole = status == 0 ? name.get() : type;
  const std::size_t end = whole.find('<');
  const std::size_t colon = whole.rfind(':', end);
  return colon == std::string::npos ? whole : whole.substr(colon + 1, end - colon - 1);
}

}  // namespace

KernelClock::~KernelClock() {
  for (const Span& span : spans_) {
    if (span.begin != nullptr) cudaEventDestroy(span.begin);
    if (span.end != nullptr) cudaEventDestroy(span.end);
  }
}

cudaError_t KernelClock::begin(const char* type, cudaStream_t stream) {
  if (count_ == spans_.size()) {
    spans_.emplace_back();
    for (cudaEvent_t* event : {&spans_.back().begin, &spans_.back().end})
      if (const cudaError_t error = cudaEventCreate(event); error != cudaSuccess) return error;
  }
  spans_[count_].name = plain_name(type);
  return cudaEventRecord(spans_[count_].begin, stream);
}

cudaError_t KernelClock::end(cudaStream_t stream) {
  return cudaEventRecord(spans_[count_++].end, stream);
}

cudaError_t KernelClock::take(std::vector<KernelTime>& times) {
  const std::size_t count = std::exchange(count_, 0);
  for (std::size_t i = 0; i < count; ++i) {
    float ms = 0;
    if (const auto error = cudaEventElapsedTime(&ms, spans_[i].begin, spans_[i].end); error != cudaSuccess)
      return error;
    times.push_back({spans_[i].name, static_cast<double>(ms)});
  }
  return cudaSuccess;
}

}  // namespace gvom::cuda
