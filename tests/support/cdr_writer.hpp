// Makes ROS 2 messages byte by byte, as recorders keep them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace gvom::test {

/// Fields in their order, each aligned to its own size from behind the head.
class CdrWriter {
 public:
  explicit CdrWriter(bool big_endian = false)
      : big_endian_(big_endian), bytes_{0, static_cast<std::uint8_t>(big_endian ? 0 : 1), 0, 0} {}

  template <typename T>
  CdrWriter& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(raw[big_endian_ ? sizeof(T) - 1 - i : i]);
    return *this;
  }
  CdrWriter& text(const std::string& text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  CdrWriter& raw(const std::vector<std::uint8_t>& octets) {
    bytes_.insert(bytes_.end(), octets.begin(), octets.end());
    return *this;
  }
  CdrWriter& octets(const std::vector<std::uint8_t>& octets) {
    return add(static_cast<std::uint32_t>(octets.size())).raw(octets);
  }
  CdrWriter& time(std::int64_t stamp_ns) {
    return add(static_cast<std::int32_t>(stamp_ns / 1'000'000'000))
        .add(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  }
  CdrWriter& header(std::int64_t stamp_ns, const std::string& frame_id) {
    return time(stamp_ns).text(frame_id);
  }

  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  bool big_endian_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace gvom::test
