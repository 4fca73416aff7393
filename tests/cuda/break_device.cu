#include "tests/cuda/break_device.hpp"

namespace gvom::test {

namespace {

__global__ void write_nowhere(int* nowhere) {
  *nowhere = 1;
}

}  // namespace

void break_device() {
  write_nowhere<<<1, 1, 0, cudaStreamPerThread>>>(reinterpret_cast<int*>(8));
  cudaStreamSynchronize(cudaStreamPerThread);  // until it has happened; what it was, the back end is to say
}

}  // namespace gvom::test
