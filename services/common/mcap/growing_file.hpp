// A file that grows at its end, and never keeps half of what was to be appended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::mcap {

class GrowingFile {
 public:
  /// Makes the file; one of that name is emptied. Errors name the file and what the system says.
  static tl::expected<GrowingFile, std::string> create(const std::string& path);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&& other) noexcept;
  ~GrowingFile();

  /// All of `bytes` or, with an error that names the file, nothing of them.
  tl::expected<void, std::string> append(const std::vector<std::uint8_t>& bytes);

  /// What closing it says: on some file systems a full disk shows only here.
  tl::expected<void, std::string> close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// CRC-32 of all that is in it.
  [[nodiscard]] std::uint32_t crc() const { return crc_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  GrowingFile(std::string path, int file) : path_(std::move(path)), file_(file) {}
  [[nodiscard]] std::string failure(int error) const;

  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;
};

}  // namespace gvom::mcap
