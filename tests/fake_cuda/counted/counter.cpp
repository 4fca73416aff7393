// Sources compiled with -fsanitize=thread call a function for each access to memory. The sanitizer's own
// library is not linked: these functions take its place, and count.
#include "tests/fake_cuda/counted/counter.hpp"

#include <cuda_runtime.h>
#include <cxxabi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include "tests/fake_cuda/fake_cuda.hpp"

namespace fake_cuda {

namespace {

// Of "std::tuple<int, gvom::cuda::UpdateBricks>" the last name.
std::string functor_name(const char* type) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(abi::__cxa_demangle(type, nullptr, nullptr, &status),
                                                         &std::free);
  if (status != 0) return type;
  std::string whole = name.get();
  while (whole.back() == '>' || whole.back() == ' ') whole.pop_back();
  whole = whole.substr(0, whole.find('<', whole.rfind("::")));
  return whole.substr(whole.rfind(':') + 1);
}

class Counter : public Observer {
 public:
  void kernel(const char* type) override {
    fold();
    kernels_.push_back({functor_name(type)});
  }
  void block() override { fold(); }

  void read(const void* at, std::size_t bytes) {
    if (kernels_.empty() || !is_device_memory(at)) return;
    kernels_.back().read_bytes += bytes;
    ++loads_[threadIdx.x % loads_.size()];
  }
  void write(const void* at, std::size_t bytes) {
    if (!kernels_.empty() && is_device_memory(at)) kernels_.back().written_bytes += bytes;
  }

  std::vector<KernelTraffic> take() {
    fold();
    return std::exchange(kernels_, {});
  }

 private:
  void fold() {
    if (!kernels_.empty()) {
      std::uint64_t& most = kernels_.back().busiest_loads;
      most = std::max(most, *std::max_element(loads_.begin(), loads_.end()));
    }
    loads_.fill(0);
  }

  std::vector<KernelTraffic> kernels_;
  std::array<std::uint64_t, 1024> loads_{};
};

Counter counter;
bool counting = false;

}  // namespace

void count_traffic() {
  counting = true;
  set_observer(&counter);
}

std::vector<KernelTraffic> take_traffic() {
  counting = false;
  set_observer(nullptr);
  return counter.take();
}

}  // namespace fake_cuda

#define COUNTED_ACCESS(bytes)                                     \
  void __tsan_read##bytes(void* at) {                             \
    if (fake_cuda::counting) fake_cuda::counter.read(at, bytes);  \
  }                                                               \
  void __tsan_write##bytes(void* at) {                            \
    if (fake_cuda::counting) fake_cuda::counter.write(at, bytes); \
  }                                                               \
  void __tsan_unaligned_read##bytes(void* at) {                   \
    __tsan_read##bytes(at);                                       \
  }                                                               \
  void __tsan_unaligned_write##bytes(void* at) {                  \
    __tsan_write##bytes(at);                                      \
  }

extern "C" {
COUNTED_ACCESS(1)
COUNTED_ACCESS(2)
COUNTED_ACCESS(4)
COUNTED_ACCESS(8)
COUNTED_ACCESS(16)
void __tsan_read_range(void* at, unsigned long bytes) {
  if (fake_cuda::counting) fake_cuda::counter.read(at, bytes);
}
void __tsan_write_range(void* at, unsigned long bytes) {
  if (fake_cuda::counting) fake_cuda::counter.write(at, bytes);
}
void __tsan_vptr_update(void** /*at*/, void* /*value*/) {}
void __tsan_vptr_read(void** /*at*/) {}
void __tsan_func_entry(void* /*caller*/) {}
void __tsan_func_exit() {}
void __tsan_init() {}
unsigned __tsan_atomic32_fetch_add(unsigned* at, unsigned value, int /*order*/) {
  __tsan_read4(at), __tsan_write4(at);
  return std::exchange(*at, *at + value);
}
unsigned __tsan_atomic32_load(const unsigned* at, int /*order*/) {
  __tsan_read4(const_cast<unsigned*>(at));
  return *at;
}
int __tsan_atomic32_compare_exchange_weak(unsigned* at, unsigned* expected, unsigned value, int /*order*/,
                                          int /*otherwise*/) {
  __tsan_write4(at);
  const bool same = *at == *expected;
  *(same ? at : expected) = same ? value : *at;
  return same ? 1 : 0;
}
void __tsan_atomic8_store(unsigned char* at, unsigned char value, int /*order*/) {
  __tsan_write1(at);
  *at = value;
}
}
