// Reading integers from packets, at any alignment.
#pragma once

#include <cstdint>
#include <cstring>

namespace gvom::ingest {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "sensors send little-endian; so must this machine be");

template <typename T>
T load_le(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

inline std::uint16_t load_be16(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

inline std::uint32_t load_be32(const std::uint8_t* bytes) {
  return static_cast<std::uint32_t>(load_be16(bytes)) << 16 | load_be16(bytes + 2);
}

}  // namespace gvom::ingest
