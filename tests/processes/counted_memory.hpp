// Counts what this program's processes allocate. A program that links it has its own malloc.
#pragma once

#include <atomic>
#include <cstdint>

namespace gvom::test {

/// In memory that processes share: counting goes on while `counting` is true.
struct AllocationCount {
  std::atomic<bool> counting{false};
  std::atomic<std::uint64_t> allocations{0};
};

/// Counts this process's allocations into `count` from now on: of all threads but iceoryx's "KeepAlive".
void count_allocations(AllocationCount& count);

/// While one lives, its thread's allocations are not counted.
class NotCounted {
 public:
  NotCounted();
  ~NotCounted();
  NotCounted(const NotCounted&) = delete;
  NotCounted& operator=(const NotCounted&) = delete;
};

}  // namespace gvom::test
