// How the CUDA back end deals with the host's memory and with a device that fails: on the serial device,
// which can be told to.
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>

#include "core/open_backend.hpp"
#include "tests/cuda/drive.hpp"
#include "tests/cuda/segment.hpp"
#include "tests/cuda/twins.hpp"
#include "tests/serial_device/serial_device.hpp"

namespace gvom::test {
namespace {

namespace serial = cuda::serial;

// Tells the serial device something for as long as it lives.
struct Told {
  explicit Told(void (*tell)(bool)) : tell_(tell) { tell_(true); }
  ~Told() { tell_(false); }
  void (*tell_)(bool);
};

TEST_CASE(
    "CUDA: a device that shares the host's memory reads maps in place, for as long as they may be read") {
  const Told shares(serial::share_host_memory);
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    CHECK(run_twins({64, 32, 30, 300, false}, 6000 + seed).added > 5);
}

TEST_CASE("CUDA: where memory cannot be pinned copies are staged, and the details say so") {
  const Told refuses(serial::refuse_to_pin);
  CHECK(run_twins({64, 32, 30, 300, false}, 6100).added > 5);
  Segment segment(1 << 20);
  const auto opened = open_fusion(Backend::cuda, {MapperConfig{}, 1, 100, segment.memory()});
  REQUIRE(opened);
  CHECK(opened->name == "cuda");
  CHECK(opened->details.find("staged copies") != std::string::npos);
  CHECK(opened->details.find("told to refuse") != std::string::npos);
}

TEST_CASE("CUDA: a steady tick takes no memory, always the same kernels, and waits once") {
  const auto drive = Drive::open(Backend::cuda).value();
  for (int i = 0; i < 20; ++i) REQUIRE(drive->step());
  const std::uint64_t before = serial::allocations();
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t waits = serial::waits();
    REQUIRE(drive->step());
    REQUIRE(drive->costs()->launches == 7);
    REQUIRE(serial::waits() == waits + 3);  // two of them are the voxelizer's: its map's size, and the map
  }
  CHECK(serial::allocations() == before);
}

TEST_CASE("CUDA: from a device's failure on nothing is given out any more, whenever it fails") {
  const std::string kFault = "an injected fault of the serial device";
  int failed_to_open = 0, failed_in_flight = 0;
  for (std::uint64_t operation = 1; operation < 1000; operation += 1 + operation / 10) {
    CAPTURE(operation);
    serial::fail_at(operation);
    const auto drive = Drive::open(Backend::cuda);
    if (!drive) {
      CHECK(drive.error().what == kFault);
      ++failed_to_open;
      continue;
    }
    int good = 0;
    while (good < 30 && (*drive)->step()) ++good;
    if (good == 30) continue;
    CHECK((*drive)->failure() == kFault);
    for (int i = 0; i < 3; ++i) CHECK_FALSE((*drive)->step());
    ++failed_in_flight;
  }
  serial::fail_at(0);
  CHECK(failed_to_open > 5);
  CHECK(failed_in_flight > 5);
}

}  // namespace
}  // namespace gvom::test
