// A device that fails, and a runtime that refuses, at every place where it can: on the fake device.
//
// These and test_serial_memory.cpp find: a launch, a copy or an allocation whose error is ignored; a back end
// that does not open; a stream that waits for the default stream; an allocation or a pageable copy within a
// capture; memory, events, graphs or a stream that are not given back.
#include <catch2/catch.hpp>
#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "tests/cuda/drive.hpp"
#include "tests/fake_cuda/fake_cuda.hpp"

namespace gvom::test {
namespace {

constexpr int kSteps = 6;  // one more than the window holds, and one of steady state

TEST_CASE("CUDA: from a device's failure on nothing is given out any more, whenever it fails") {
  const std::string kFault = "an illegal memory access";
  int failed_to_open = 0, failed_in_flight = 0;
  for (std::uint64_t operation = 1; operation < 1000; operation += 1 + operation / 10) {
    CAPTURE(operation);
    fake_cuda::fail_at(operation);
    const auto drive = Drive::open(Backend::cuda);
    if (!drive) {
      CHECK(drive.error().what.find(kFault) != std::string::npos);
      ++failed_to_open;
      continue;
    }
    int good = 0;
    while (good < 30 && (*drive)->step()) ++good;
    if (good == 30) continue;
    CHECK((*drive)->failure().find(kFault) != std::string::npos);
    for (int i = 0; i < 3; ++i) CHECK_FALSE((*drive)->step());
    ++failed_in_flight;
  }
  fake_cuda::fail_at(0);
  CHECK(failed_to_open > 5);
  CHECK(failed_in_flight > 5);
}

TEST_CASE("CUDA: no driver, an old one and no device are told apart") {
  const auto words = [](fake_cuda::Absent what) {
    fake_cuda::lack(what);
    const auto opened = Drive::open(Backend::cuda);
    fake_cuda::lack(fake_cuda::Absent::nothing);
    return opened ? "" : opened.error().what;
  };
  CHECK(words(fake_cuda::Absent::driver) == "no NVIDIA driver");
  CHECK(words(fake_cuda::Absent::new_driver) ==
        "the NVIDIA driver is too old: it runs programs of CUDA 11.0, this is one of 13.0");
  CHECK(words(fake_cuda::Absent::device) == "looking for a CUDA device: no CUDA-capable device is detected");
}

TEST_CASE("CUDA: a call that is refused once is told, or does no harm") {
  std::string expected;
  {
    const auto drive = Drive::open(Backend::cuda).value();
    for (int i = 0; i < kSteps; ++i) REQUIRE(drive->step());
    expected = drive->layer_bytes();
  }
  std::set<std::string> told, harmless;
  for (std::uint64_t call = 1;; ++call) {
    fake_cuda::refuse_call(call);
    const auto drive = Drive::open(Backend::cuda);
    int steps = 0;
    while (drive && steps < kSteps && (*drive)->step()) ++steps;
    const std::string refused = fake_cuda::refused_call();
    fake_cuda::refuse_call(0);
    if (refused.empty()) break;  // it came too late
    CAPTURE(call, refused);
    const bool good = drive && steps == kSteps;
    if (good) CHECK((*drive)->layer_bytes() == expected);
    (good ? harmless : told).insert(refused);
  }
  CHECK(fake_cuda::leftovers().empty());
  // Memory that cannot be pinned is copied by the driver; a graph that is not destroyed is one that is kept.
  CHECK(harmless == std::set<std::string>{"cudaGraphDestroy", "cudaHostRegister"});
  for (const char* call :
       {"cudaMalloc", "cudaMallocHost", "cudaMemcpyAsync", "cudaMemsetAsync", "launch", "cudaGraphLaunch",
        "cudaStreamSynchronize", "cudaStreamBeginCapture", "cudaGraphInstantiate"})
    CHECK(told.count(call) == 1);
}

}  // namespace
}  // namespace gvom::test
