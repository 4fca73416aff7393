#include "services/common/ros/cdr_reader.hpp"

#include <cstdio>

namespace gvom::ros {
namespace {

constexpr std::size_t kHeadBytes = 4;

std::string hex(unsigned value) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%04x", value);
  return text;
}

}  // namespace

CdrReader::CdrReader(Bytes message) {
  if (message.size < kHeadBytes) {
    fail("shorter than the head of a CDR message");
    return;
  }
  const unsigned encoding = static_cast<unsigned>(message.data[0]) << 8 | message.data[1];
  if (encoding > 1) {
    fail("encoding " + hex(encoding) + " is not CDR (0x0000, 0x0001)");
    return;
  }
  big_endian_ = encoding == 0;
  body_ = message.data + kHeadBytes;
  size_ = message.size - kHeadBytes;
}

void CdrReader::fail(const std::string& reason) {
  if (error_.empty())
    error_ = "byte " + std::to_string(at_ + (body_ != nullptr ? kHeadBytes : 0)) + ": " + reason;
}

const std::uint8_t* CdrReader::take(std::size_t size, std::size_t alignment) {
  if (!ok()) return nullptr;
  const std::size_t padding = (alignment - at_ % alignment) % alignment;
  if (padding > left() || size > left() - padding) {
    fail("the message ends before " + std::to_string(size) + " bytes that should follow");
    return nullptr;
  }
  const std::uint8_t* const bytes = body_ + at_ + padding;
  at_ += padding + size;
  return bytes;
}

std::string_view CdrReader::string(std::size_t most) {
  const auto length = read<std::uint32_t>();
  if (!ok() || length == 0) return {};  // some writers leave out the NUL of an empty string
  if (length - 1 > most) {
    fail("a string of " + std::to_string(length - 1) + " bytes, more than " + std::to_string(most));
    return {};
  }
  const std::uint8_t* const bytes = take(length, 1);
  if (bytes == nullptr) return {};
  if (bytes[length - 1] != 0) {
    fail("a string without its NUL");
    return {};
  }
  return {reinterpret_cast<const char*>(bytes), length - 1};
}

Bytes CdrReader::octets() {
  return array(count(1));
}

Bytes CdrReader::array(std::size_t size) {
  const std::uint8_t* const bytes = take(size, 1);
  return bytes == nullptr ? Bytes{} : Bytes{bytes, size};
}

std::uint32_t CdrReader::count(std::size_t least_bytes) {
  const auto elements = read<std::uint32_t>();
  if (ok() && elements > left() / least_bytes)
    fail("a sequence of " + std::to_string(elements) + " elements, more than the message can hold");
  return ok() ? elements : 0;
}

}  // namespace gvom::ros
