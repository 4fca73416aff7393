#include "services/common/mcap/growing_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gvom::mcap {

tl::expected<GrowingFile, std::string> GrowingFile::create(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return tl::unexpected(path + ": " + std::strerror(errno));
  return GrowingFile(path, file);
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      size_(other.size_),
      crc_(other.crc_) {}

GrowingFile& GrowingFile::operator=(GrowingFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(size_, other.size_);
  std::swap(crc_, other.crc_);
  return *this;
}

GrowingFile::~GrowingFile() {
  if (file_ >= 0) ::close(file_);
}

std::string GrowingFile::failure(int error) const {
  return path_ + ": " + std::strerror(error) + " after " + std::to_string(size_) + " bytes";
}

tl::expected<void, std::string> GrowingFile::append(const std::vector<std::uint8_t>& bytes) {
  if (file_ < 0) return tl::unexpected(path_ + ": it is closed");
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t wrote = ::write(file_, bytes.data() + done, bytes.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) {
      const int error = wrote < 0 ? errno : ENOSPC;
      // Needs no room, and what follows begins where this did.
      if (::ftruncate(file_, static_cast<off_t>(size_)) == 0)
        ::lseek(file_, static_cast<off_t>(size_), SEEK_SET);
      return tl::unexpected(failure(error));
    }
    done += static_cast<std::size_t>(wrote);
  }
  size_ += bytes.size();
  crc_ = static_cast<std::uint32_t>(::crc32(crc_, bytes.data(), static_cast<uInt>(bytes.size())));
  return {};
}

tl::expected<void, std::string> GrowingFile::close() {
  const int file = std::exchange(file_, -1);
  if (file >= 0 && ::close(file) != 0) return tl::unexpected(failure(errno));
  return {};
}

}  // namespace gvom::mcap
