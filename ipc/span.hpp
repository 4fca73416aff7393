// A view of an array that somebody else owns.
#pragma once

#include <cstddef>
#include <type_traits>

namespace gvom::ipc {

template <typename T>
class Span {
 public:
  Span() = default;
  Span(T* data, std::size_t size) : data_(data), size_(size) {}
  /// A view to write through is also one to read through.
  template <typename U, typename = std::enable_if_t<std::is_same_v<T, const U>>>
  Span(const Span<U>& other) : data_(other.data()), size_(other.size()) {}  // NOLINT: implicit by intent

  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] T* begin() const { return data_; }
  [[nodiscard]] T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace gvom::ipc
