// A file without a disk, for parsers that take a file's name.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "tests/fuzz/input.hpp"

namespace gvom::fuzz {

class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    require(descriptor_ >= 0, "there are memory files");
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void set(const void* data, std::size_t size) const {
    require(::pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size), "a memory file takes it all");
    require(::ftruncate(descriptor_, static_cast<off_t>(size)) == 0, "a memory file can be cut");
  }
  void set(ingest::Bytes bytes) const { set(bytes.data, bytes.size); }
  void set(const std::string& text) const { set(text.data(), text.size()); }

  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace gvom::fuzz
