// Checksums of large arrays, as fast as memory is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace gvom::endurance {

/// One changed word always changes the sum: each step maps 64 bits one to one.
class Checksum {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (; bytes >= sizeof lanes_; at += sizeof lanes_, bytes -= sizeof lanes_) {
      std::uint64_t words[kLanes];
      std::memcpy(words, at, sizeof words);
      for (int i = 0; i < kLanes; ++i) lanes_[i] = mixed(lanes_[i], words[i]);
    }
    for (; bytes > 0; ++at, --bytes) lanes_[0] = mixed(lanes_[0], *at);
  }
  template <typename T>
  void add(const T& value) {
    add(&value, sizeof value);
  }

  [[nodiscard]] std::uint64_t value() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t lane : lanes_) sum = mixed(sum, lane);
    return sum;
  }

 private:
  static constexpr int kLanes = 4;  // so that one multiplication needs not wait for the other

  static std::uint64_t mixed(std::uint64_t sum, std::uint64_t word) {
    sum = (sum ^ word) * 0x9E3779B97F4A7C15u;
    return sum ^ sum >> 32;
  }

  std::uint64_t lanes_[kLanes] = {1, 2, 3, 4};
};

}  // namespace gvom::endurance
