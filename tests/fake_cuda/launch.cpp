// Kernels: each of their threads runs on the host, in an order that can be told.
#include <array>
#include <numeric>
#include <thread>
#include <utility>

#include "tests/fake_cuda/state.hpp"

namespace fake_cuda {

namespace {

constexpr std::uint64_t kHostThreads = 4;

using Threads = std::function<void(std::uint64_t begin, std::uint64_t end)>;

struct Launch {
  dim3 grid, block;
  const char* type;
  Threads run;

  [[nodiscard]] std::uint64_t threads() const { return std::uint64_t{grid.x} * block.x; }
};

void prepare(const Launch& launch) {
  gridDim = launch.grid;
  blockDim = launch.block;
}

// i -> (a i + b) mod n, a having no divisor in common with n: another order at each launch.
void run_shuffled(const Launch& launch) {
  static std::uint64_t seed = 1;
  seed = seed * 6364136223846793005U + 1442695040888963407U;
  const std::uint64_t n = launch.threads();
  std::uint64_t a = (seed >> 33) % n | 1;
  while (std::gcd(a, n) != 1) a += 2;
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t thread = (a * i + (seed >> 13) % n) % n;
    launch.run(thread, thread + 1);
  }
}

// Neighbours are on different threads. Dealt by hash: by `i % 4`, a race between indices that are 4 apart is
// missed.
void run_on_threads(const Launch& launch) {
  std::array<std::thread, kHostThreads> threads;
  for (std::uint64_t t = 0; t < kHostThreads; ++t)
    threads[t] = std::thread([t, &launch] {
      prepare(launch);
      for (std::uint64_t i = 0; i < launch.threads(); ++i)
        if ((i * 0x9E3779B97F4A7C15U >> 62) == t) launch.run(i, i + 1);
    });
  for (std::thread& thread : threads) thread.join();
}

void run_observed(const Launch& launch, Observer& observer) {
  observer.kernel(launch.type);
  for (std::uint64_t block = 0; block < launch.grid.x; ++block) {
    observer.block();
    launch.run(block * launch.block.x, (block + 1) * launch.block.x);
  }
}

void run_all(const Launch& launch) {
  prepare(launch);
  if (state().observer != nullptr) return run_observed(launch, *state().observer);
  switch (state().order) {
    case Order::shuffled:
      return run_shuffled(launch);
    case Order::threads:
      return run_on_threads(launch);
    case Order::reverse:
      for (std::uint64_t i = launch.threads(); i-- > 0;) launch.run(i, i + 1);
      return;
    case Order::forward:
      launch.run(0, launch.threads());
  }
}

}  // namespace

cudaError_t launch(const cudaLaunchConfig_t& config, const char* type, Threads threads) {
  FAKE_CUDA_ENTER(InCapture::allowed, cudaErrorLaunchOutOfResources);
  require_stream("launch", config.stream);
  if (config.gridDim.x == 0 || config.blockDim.x == 0 || config.blockDim.x > 1024)
    return give(cudaErrorInvalidValue);
  enqueue(config.stream,
          [whole = Launch{config.gridDim, config.blockDim, type, std::move(threads)}] { run_all(whole); });
  return cudaSuccess;
}

}  // namespace fake_cuda
