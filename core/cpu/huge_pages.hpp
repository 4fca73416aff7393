// Arrays of a value for each voxel lie in pages of 2 MB where the system has them: columns are read far
// apart, and with pages of 4 KB each look would wait for its page's entry too.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gvom::cpu {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

template <class T>
struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class Other>
  explicit HugePages(const HugePages<Other>& /*other*/) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = (count * sizeof(T) + kHugePage - 1) / kHugePage * kHugePage;
    void* const memory = std::aligned_alloc(kHugePage, bytes);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
    static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));  // refused: it lies in small ones
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t /*count*/) {
    std::free(memory);
  }

  template <class Other>
  bool operator==(const HugePages<Other>& /*other*/) const {
    return true;
  }
  template <class Other>
  bool operator!=(const HugePages<Other>& /*other*/) const {
    return false;
  }
};

/// For each voxel of a grid.
template <class T>
using VoxelArray = std::vector<T, HugePages<T>>;

}  // namespace gvom::cpu
