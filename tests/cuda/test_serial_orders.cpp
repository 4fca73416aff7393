// Kernels whose threads run in other orders, and on several threads of the host at once. Under
// ThreadSanitizer the latter finds an atomic made plain, and masks that are written by read-modify-write: the
// neighbours' bits are lost.
#include <catch2/catch.hpp>

#include "tests/cuda/drive.hpp"
#include "tests/cuda/twins.hpp"
#include "tests/fake_cuda/fake_cuda.hpp"

namespace gvom::test {
namespace {

struct Ordered {
  explicit Ordered(fake_cuda::Order order) { fake_cuda::set_order(order); }
  ~Ordered() { fake_cuda::set_order(fake_cuda::Order::forward); }
};

TEST_CASE("CUDA: the order in which a kernel's threads run does not show") {
  for (const auto order : {fake_cuda::Order::reverse, fake_cuda::Order::shuffled}) {
    const Ordered ordered(order);
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      CHECK(run_twins({64, 32, 20, 300, seed == 2, seed == 3 ? 1.0 : 0.0}, 8000 + seed).added > 5);
  }
}

TEST_CASE("CUDA: threads of a kernel that run at once do not disturb each other") {
  const Ordered ordered(fake_cuda::Order::threads);
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    CHECK(run_twins({64, 32, 12, 300, seed == 2, seed == 3 ? 0.5 : 0.0}, 8100 + seed).added > 3);
}

}  // namespace
}  // namespace gvom::test
