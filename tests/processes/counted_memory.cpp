#include "tests/processes/counted_memory.hpp"

#include <execinfo.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

// What glibc's own malloc is called: ours stands before it, also for the libraries.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

constexpr std::uint64_t kMostTraces = 8;

gvom::test::AllocationCount* count = nullptr;
thread_local int paused = 0;

/// iceoryx's own thread, which tells the broker every half second that we live, and builds strings for it.
bool in_keep_alive_thread() {
  char name[16] = {};
  ::prctl(PR_GET_NAME, name);
  return std::strcmp(name, "KeepAlive") == 0;
}

/// The first few are shown with their callers: whoever reads the failure wants to know.
void note() {
  if (count == nullptr || paused > 0 || !count->counting || in_keep_alive_thread()) return;
  if (++count->allocations > kMostTraces) return;
  ++paused;
  void* callers[24];
  const int depth = ::backtrace(callers, 24);
  constexpr char kTitle[] = "allocation in the steady state:\n";
  (void)!::write(STDERR_FILENO, kTitle, sizeof kTitle - 1);
  ::backtrace_symbols_fd(callers, depth, STDERR_FILENO);
  --paused;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}

void* calloc(std::size_t number, std::size_t size) {
  note();
  return __libc_calloc(number, size);
}

void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  note();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}

}  // extern "C"

namespace gvom::test {

void count_allocations(AllocationCount& to) {
  void* caller = nullptr;
  ::backtrace(&caller, 1);  // loads what it needs
  count = &to;
}

NotCounted::NotCounted() {
  ++paused;
}

NotCounted::~NotCounted() {
  --paused;
}

}  // namespace gvom::test
