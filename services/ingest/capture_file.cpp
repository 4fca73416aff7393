#include "services/ingest/capture_file.hpp"

#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <string_view>

namespace gvom::ingest {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kGzip = "\x1F\x8B"sv;

struct Packer {
  std::string_view magic;
  const char* name;
  const char* unpacker;
};
constexpr Packer kPackers[] = {
    {"\x28\xB5\x2F\xFD"sv, "zstd", "unzstd"},
    {"\xFD\x37\x7A\x58\x5A"sv, "xz", "unxz"},
    {"BZh"sv, "bzip2", "bunzip2"},
    {"\x04\x22\x4D\x18"sv, "lz4", "unlz4"},
    {"PK\x03\x04"sv, "zip", "unzip"},
};

ssize_t read_gzip(void* cookie, char* buffer, std::size_t size) {
  const int read = ::gzread(static_cast<gzFile>(cookie), buffer, static_cast<unsigned>(size));
  if (read < 0) errno = EBADMSG;
  return read;
}

int close_gzip(void* cookie) {
  return ::gzclose_r(static_cast<gzFile>(cookie)) == Z_OK ? 0 : -1;
}

std::string system_error(const std::string& path) {
  return path + ": " + std::strerror(errno);
}

}  // namespace

tl::expected<CaptureFile, std::string> open_capture_file(const std::string& path) {
  CaptureFile file(std::fopen(path.c_str(), "rb"));
  if (!file) return tl::unexpected(system_error(path));
  char begin[8] = {};
  const std::string_view found(begin, std::fread(begin, 1, sizeof begin, file.get()));
  for (const Packer& packer : kPackers)
    if (found.substr(0, packer.magic.size()) == packer.magic)
      return tl::unexpected(path + ": is packed by " + packer.name + ": unpack it first: " + packer.unpacker +
                            " " + path);
  std::rewind(file.get());
  if (found.substr(0, kGzip.size()) != kGzip) return file;
  const gzFile packed = ::gzopen(path.c_str(), "rb");
  if (packed == nullptr) return tl::unexpected(system_error(path));
  CaptureFile unpacked(::fopencookie(packed, "rb", {read_gzip, nullptr, nullptr, close_gzip}));
  if (unpacked) return unpacked;
  ::gzclose_r(packed);
  return tl::unexpected(system_error(path));
}

}  // namespace gvom::ingest
