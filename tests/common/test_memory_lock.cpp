// Locked memory, as the kernel counts it.
#include <catch2/catch.hpp>

#include <fstream>
#include <string>

#include <sys/mman.h>
#include <sys/resource.h>

#include "services/common/memory_lock.hpp"

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

long locked_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmLck:", 0) == 0) return std::stol(line.substr(6));
  }
  return -1;
}

}  // namespace

TEST_CASE("memory is locked, or it is said which limit is in the way") {
  if (kSanitized) {
    WARN("SKIPPED: sanitizers make mlockall do nothing");
    return;
  }
  REQUIRE(locked_kb() == 0);
  const auto locked = gvom::services::lock_memory();
  if (locked) {
    CHECK(locked_kb() > 0);
  } else {
    WARN("SKIPPED: memory can't be locked here: " + locked.error());
    CHECK(locked.error().find("LimitMEMLOCK") != std::string::npos);
    CHECK(locked_kb() == 0);
  }
  munlockall();
}
