// A file that is read here and there, never as a whole.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/ros/cdr_reader.hpp"

namespace gvom::mcap {

class RandomFile {
 public:
  /// Errors name the file and say why it can't be opened.
  static tl::expected<RandomFile, std::string> open(const std::string& path);
  ~RandomFile();
  RandomFile(RandomFile&& other) noexcept;
  RandomFile& operator=(RandomFile&& other) noexcept;

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Fills `out` with the `bytes` from `offset`; false where the file has none such or can't be read there.
  bool read(std::uint64_t offset, std::size_t bytes, std::vector<std::uint8_t>& out) const;

  /// A few bytes, at most 64, of those that lie close to each other; valid until the next call. Fewer than
  /// asked for at the file's end.
  ros::Bytes peek(std::uint64_t offset, std::size_t bytes);

 private:
  RandomFile(int file, std::uint64_t size) : file_(file), size_(size) {}

  int file_ = -1;
  std::uint64_t size_ = 0;
  std::vector<std::uint8_t> window_;
  std::uint64_t window_at_ = 0;
};

}  // namespace gvom::mcap
