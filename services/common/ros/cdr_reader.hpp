// Reads CDR, the bytes of a ROS 2 message, from a buffer that nobody vouches for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace gvom::ros {

/// Bytes of somebody else's, in one piece.
struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Fields in their order, each aligned to its own size, counted from behind the head of four bytes. Both byte
/// orders are read. After the first error every read gives 0 or nothing, and `error` keeps the first reason.
/// Bytes that are left over at the end are no error: recorders and DDS pad.
class CdrReader {
 public:
  /// `message` with its head; it outlives the reader and all that the reader gives.
  explicit CdrReader(Bytes message);

  [[nodiscard]] bool ok() const { return error_.empty(); }
  /// "byte 12: ...", counted from the head's first; empty if all is well.
  [[nodiscard]] const std::string& error() const { return error_; }
  [[nodiscard]] bool is_big_endian() const { return big_endian_; }
  [[nodiscard]] std::size_t left() const { return size_ - at_; }

  /// A number, or a `bool` as std::uint8_t.
  template <typename T>
  T read() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    const std::uint8_t* const bytes = take(sizeof(T), sizeof(T));
    if (bytes == nullptr) return value;
    std::uint8_t ordered[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) ordered[i] = bytes[big_endian_ ? sizeof(T) - 1 - i : i];
    std::memcpy(&value, ordered, sizeof(T));
    return value;
  }

  /// Without its closing NUL; at most `most` bytes.
  std::string_view string(std::size_t most);

  /// A sequence of uint8, int8 or byte.
  Bytes octets();

  /// An array of `size` octets, without a count.
  Bytes array(std::size_t size);

  /// The count of a sequence whose elements take `least_bytes` each, or more: one that the message cannot
  /// hold is an error.
  std::uint32_t count(std::size_t least_bytes);

  /// The first reason counts.
  void fail(const std::string& reason);

 private:
  /// Null, and an error, where the message ends before.
  const std::uint8_t* take(std::size_t size, std::size_t alignment);

  const std::uint8_t* body_ = nullptr;  // behind the head
  std::size_t size_ = 0;
  std::size_t at_ = 0;
  bool big_endian_ = false;
  std::string error_;
};

}  // namespace gvom::ros
