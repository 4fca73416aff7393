// Puts the records of an MCAP file together. Internal to services/common/mcap.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gvom::mcap {

/// Appends to `bytes`, which outlives it. Little endian, nothing aligned.
class RecordWriter {
 public:
  explicit RecordWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  /// Begins a record, whose length end() fills in.
  void begin(std::uint8_t opcode) {
    number(opcode);
    begin_ = bytes_.size();
    number(std::uint64_t{0});
  }
  void end() {
    const std::uint64_t length = bytes_.size() - begin_ - sizeof(std::uint64_t);
    std::memcpy(bytes_.data() + begin_, &length, sizeof length);
  }

  template <typename T>
  void number(T value) {
    static_assert(std::is_integral_v<T>);
    raw(&value, sizeof value);
  }
  void raw(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(from);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    raw(value.data(), value.size());
  }

  /// A map of numbers, with its length in bytes before it.
  void numbers(const std::map<std::uint16_t, std::uint64_t>& values) {
    number(static_cast<std::uint32_t>(values.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
    for (const auto& [key, value] : values) {
      number(key);
      number(value);
    }
  }
  /// Likewise of texts.
  void texts(const std::map<std::string, std::string>& values) {
    std::size_t length = 0;
    for (const auto& [key, value] : values) length += 2 * sizeof(std::uint32_t) + key.size() + value.size();
    number(static_cast<std::uint32_t>(length));
    for (const auto& [key, value] : values) {
      text(key);
      text(value);
    }
  }

 private:
  std::vector<std::uint8_t>& bytes_;
  std::size_t begin_ = 0;
};

}  // namespace gvom::mcap
