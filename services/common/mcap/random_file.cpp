#include "services/common/mcap/random_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace gvom::mcap {
namespace {

constexpr std::size_t kWindowBytes = 64 << 10;

}  // namespace

tl::expected<RandomFile, std::string> RandomFile::open(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return tl::unexpected(path + ": " + std::strerror(errno));
  RandomFile opened(file, 0);
  struct stat status {};
  if (::fstat(file, &status) != 0) return tl::unexpected(path + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return tl::unexpected(path + ": is no file");
  opened.size_ = static_cast<std::uint64_t>(status.st_size);
  return opened;
}

RandomFile::~RandomFile() {
  if (file_ >= 0) ::close(file_);
}

RandomFile::RandomFile(RandomFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      size_(other.size_),
      window_(std::move(other.window_)),
      window_at_(other.window_at_) {}

RandomFile& RandomFile::operator=(RandomFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(size_, other.size_);
  std::swap(window_, other.window_);
  std::swap(window_at_, other.window_at_);
  return *this;
}

bool RandomFile::read(std::uint64_t offset, std::size_t bytes, std::vector<std::uint8_t>& out) const {
  if (offset > size_ || bytes > size_ - offset) return false;
  out.resize(bytes);
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got = ::pread(file_, out.data() + done, bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

ros::Bytes RandomFile::peek(std::uint64_t offset, std::size_t bytes) {
  if (offset >= size_) return {};
  const std::size_t wanted = std::min<std::uint64_t>(bytes, size_ - offset);
  const bool inside = offset >= window_at_ && offset - window_at_ + wanted <= window_.size();
  if (!inside) {
    window_at_ = offset;
    if (!read(offset, std::min<std::uint64_t>(kWindowBytes, size_ - offset), window_)) {
      window_.clear();
      return {};
    }
  }
  return {window_.data() + (offset - window_at_), wanted};
}

}  // namespace gvom::mcap
