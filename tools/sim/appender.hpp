// Integers as bytes of a packet, either byte order.
#pragma once

#include <cstdint>

namespace gvom::sim {

class Appender {
 public:
  explicit Appender(std::uint8_t* at) : at_(at) {}

  Appender& little(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) *at_++ = static_cast<std::uint8_t>(value >> 8 * i);
    return *this;
  }

  Appender& big(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) *at_++ = static_cast<std::uint8_t>(value >> 8 * i);
    return *this;
  }

  [[nodiscard]] std::uint8_t* at() const { return at_; }

 private:
  std::uint8_t* at_;
};

}  // namespace gvom::sim
