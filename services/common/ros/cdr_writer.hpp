// Writes CDR as ROS 2 sends it: XCDR1, little endian, numbers aligned to their own size counted from behind
// the four-byte head.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gvom::ros {

/// Appends to a vector whose memory is used again: warm, it allocates nothing.
class CdrWriter {
 public:
  /// Empties `bytes`, which outlives the writer, and writes the head.
  explicit CdrWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {
    const std::uint8_t head[kHead] = {0, 1, 0, 0};
    bytes_.assign(head, head + kHead);
  }

  /// An integer or a floating-point number; a bool is to be given as std::uint8_t.
  template <typename T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    std::memcpy(append<T>(1), &value, sizeof value);
  }

  /// Its length with the zero behind it, itself, the zero.
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    std::uint8_t* to = append<std::uint8_t>(value.size() + 1);
    std::memcpy(to, value.data(), value.size());
    to[value.size()] = 0;
  }

  /// How many elements of a sequence follow.
  void count(std::size_t elements) { number(static_cast<std::uint32_t>(elements)); }

  /// Room for `elements` numbers of type T, to be filled by memcpy: valid until the next call. Sizes in
  /// bytes; their padding is zero.
  template <typename T>
  std::uint8_t* append(std::size_t elements) {
    const std::size_t begin = (bytes_.size() - kHead + sizeof(T) - 1) / sizeof(T) * sizeof(T) + kHead;
    bytes_.resize(elements == 0 ? bytes_.size() : begin + elements * sizeof(T));
    return bytes_.data() + begin;
  }

 private:
  static constexpr std::size_t kHead = 4;
  std::vector<std::uint8_t>& bytes_;
};

}  // namespace gvom::ros
