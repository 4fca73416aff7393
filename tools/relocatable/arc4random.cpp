// What libstdc++ and libexpat of Debian 12 ask of glibc 2.36, for systems with 2.35 (Ubuntu 22.04): random
// bytes from the kernel.
#include <sys/random.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" void arc4random_buf(void* buffer, std::size_t bytes) {
  char* next = static_cast<char*>(buffer);
  while (bytes > 0) {
    const ssize_t got = ::getrandom(next, bytes, 0);
    if (got < 0 && errno != EINTR) std::abort();  // as glibc does
    if (got < 0) continue;
    next += got;
    bytes -= static_cast<std::size_t>(got);
  }
}

extern "C" std::uint32_t arc4random() {
  std::uint32_t value = 0;
  arc4random_buf(&value, sizeof value);
  return value;
}
