// Builds small captures, byte by byte.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace gvom::test {

using ByteVector = std::vector<std::uint8_t>;

template <typename T>
void put_le(ByteVector& out, T value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

inline void put_be16(ByteVector& out, std::size_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value));
}

inline void append(ByteVector& out, const ByteVector& more) {
  out.insert(out.end(), more.begin(), more.end());
}

/// How a datagram is sent.
struct Sent {
  std::uint8_t host = 1;  ///< The sender is 10.0.0.HOST.
  std::uint16_t port = 7502;
  std::uint16_t id = 1;  ///< Of the IP datagram.
};

inline ByteVector udp(const ByteVector& payload, const Sent& sent = {}) {
  ByteVector out;
  put_be16(out, 40000);
  put_be16(out, sent.port);
  put_be16(out, payload.size() + 8);
  put_be16(out, 0);
  append(out, payload);
  return out;
}

/// An IPv4 packet. `fragment` is the field of flags and offset (in units of 8 bytes).
inline ByteVector ipv4(const ByteVector& body, const Sent& sent = {}, std::size_t fragment = 0) {
  ByteVector out{0x45, 0};
  put_be16(out, body.size() + 20);
  put_be16(out, sent.id);
  put_be16(out, fragment);
  append(out, {64, 17, 0, 0, 10, 0, 0, sent.host, 10, 0, 0, 200});
  append(out, body);
  return out;
}

inline ByteVector ipv6(const ByteVector& body, std::uint8_t next_header = 17) {
  ByteVector out{0x60, 0, 0, 0};
  put_be16(out, body.size());
  append(out, {next_header, 64});
  for (int i = 0; i < 32; ++i) out.push_back(static_cast<std::uint8_t>(i));
  append(out, body);
  return out;
}

inline ByteVector ethernet(const ByteVector& ip, std::size_t type = 0x0800) {
  ByteVector out(12, 0xAA);
  put_be16(out, type);
  append(out, ip);
  return out;
}

/// One whole frame: Ethernet, IPv4, UDP.
inline ByteVector frame(const ByteVector& payload, const Sent& sent = {}) {
  return ethernet(ipv4(udp(payload, sent), sent));
}

/// The frames of a datagram in IP fragments of `part` bytes (a multiple of 8).
inline std::vector<ByteVector> fragments(const ByteVector& payload, std::size_t part, const Sent& sent = {}) {
  const ByteVector whole = udp(payload, sent);
  std::vector<ByteVector> out;
  for (std::size_t at = 0; at < whole.size(); at += part) {
    const std::size_t end = std::min(at + part, whole.size());
    const ByteVector body(whole.begin() + static_cast<long>(at), whole.begin() + static_cast<long>(end));
    out.push_back(ethernet(ipv4(body, sent, at / 8 | (end < whole.size() ? 0x2000u : 0u))));
  }
  return out;
}

/// A classic pcap file; microseconds, or nanoseconds.
class PcapWriter {
 public:
  explicit PcapWriter(std::string path, std::uint32_t link_type = 1, bool nanoseconds = false)
      : path_(std::move(path)), nanoseconds_(nanoseconds) {
    for (const std::uint32_t word :
         {nanoseconds ? 0xA1B23C4Du : 0xA1B2C3D4u, 0x00040002u, 0u, 0u, 262144u, link_type}) {
      put_le(bytes_, word);
    }
  }

  /// `missing` bytes of the frame were not captured.
  void add(const ByteVector& frame, std::int64_t time_ns = 0, std::size_t missing = 0) {
    put_le(bytes_, static_cast<std::uint32_t>(time_ns / 1'000'000'000));
    put_le(bytes_, static_cast<std::uint32_t>(time_ns % 1'000'000'000 / (nanoseconds_ ? 1 : 1000)));
    put_le(bytes_, static_cast<std::uint32_t>(frame.size() - missing));
    put_le(bytes_, static_cast<std::uint32_t>(frame.size()));
    bytes_.insert(bytes_.end(), frame.begin(), frame.end() - static_cast<long>(missing));
  }

  /// Writes the file, without its last `cut` bytes, and returns its path.
  std::string write(std::size_t cut = 0) const {
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes_.data()), static_cast<long>(bytes_.size() - cut));
    return path_;
  }

 private:
  std::string path_;
  bool nanoseconds_;
  ByteVector bytes_;
};

}  // namespace gvom::test
