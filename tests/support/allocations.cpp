#include "tests/support/allocations.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1  // as g++ has it
#endif
#endif

namespace {
std::atomic<std::uint64_t> count{0};
}

#ifndef __SANITIZE_ADDRESS__
// In place of the C library's.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}
}
#endif

namespace gvom::test {

std::uint64_t allocations() {
  return count;
}

bool counts_allocations() {
#ifdef __SANITIZE_ADDRESS__
  WARN("SKIPPED: allocations are not counted under the address sanitizer");
  return false;
#else
  return true;
#endif
}

}  // namespace gvom::test
