// A CUDA error in flight that nothing but a new process cures.
#include <catch2/catch.hpp>

#include "tests/cuda/break_device.hpp"
#include "tests/cuda/drive.hpp"
#include "tests/cuda/gpu.hpp"

namespace gvom::test {
namespace {

TEST_CASE("after a kernel's fault the back end gives nothing out any more, and says why") {
  if (!has_gpu()) return;
  const auto drive = Drive::open(Backend::cuda).value();
  for (int i = 0; i < 20; ++i) REQUIRE(drive->step());
  break_device();
  int good = 0;
  while (good < 3 && drive->step()) ++good;
  CHECK(good < 3);  // what was on its way may still arrive
  CHECK(drive->failure().find("illegal") != std::string::npos);
  for (int i = 0; i < 10; ++i) CHECK_FALSE(drive->step());
  const auto another = Drive::open(Backend::cuda);
  CHECK_FALSE(another);
}

}  // namespace
}  // namespace gvom::test
