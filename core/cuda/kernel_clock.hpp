// How long each kernel takes, by events around it. Off unless asked for: graphs are not played as one then.
#pragma once

#include <cuda_runtime.h>

#include <string>
#include <vector>

#include "core/backend.hpp"

namespace gvom::cuda {

class KernelClock {
 public:
  KernelClock() = default;
  ~KernelClock();
  KernelClock(const KernelClock&) = delete;
  KernelClock& operator=(const KernelClock&) = delete;

  void start() { runs_ = true; }
  [[nodiscard]] bool runs() const { return runs_; }
  /// Whether the next kernel is the first since the last `take`.
  [[nodiscard]] bool is_first() const { return count_ == 0; }

  /// Around a launch. `type` is the name of a type as typeid tells it.
  cudaError_t begin(const char* type, cudaStream_t stream);
  cudaError_t end(cudaStream_t stream);

  /// Of each kernel since the last call, in order; when the stream has been waited for.
  cudaError_t take(std::vector<KernelTime>& times);

 private:
  struct Span {
    std::string name;
    cudaEvent_t begin = nullptr, end = nullptr;
  };

  bool runs_ = false;
  std::vector<Span> spans_;  // the first `count_` are of now, the others' events are used again
  std::size_t count_ = 0;
};

}  // namespace gvom::cuda
