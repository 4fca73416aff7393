#include "services/common/bag/zstd_unpack.hpp"

#include <sys/statvfs.h>
#include <unistd.h>
#include <zstd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

namespace gvom::bag {
namespace {

constexpr std::uint64_t kStaysFreeBytes = 256 << 20;
constexpr std::size_t kPieceBytes = 1 << 20;
constexpr std::array<std::uint8_t, 4> kZstdMagic{0x28, 0xB5, 0x2F, 0xFD};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;
using Result = tl::expected<void, std::string>;

Result check_room(int file) {
  struct statvfs room {};
  if (::fstatvfs(file, &room) != 0) return {};
  if (std::uint64_t{room.f_bavail} * room.f_frsize > kStaysFreeBytes) return {};
  return tl::unexpected(std::string("no room to unpack it (TMPDIR says where)"));
}

/// Unpacks piece by piece; `stopped` says why it ended before the end of `in`, if it did.
Result unpack_stream(std::FILE* in, std::FILE* out, std::string& stopped) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  std::vector<std::uint8_t> packed(kPieceBytes);
  std::vector<std::uint8_t> unpacked(kPieceBytes);
  std::size_t open_frame = 0;
  while (const std::size_t got = std::fread(packed.data(), 1, packed.size(), in)) {
    ZSTD_inBuffer from{packed.data(), got, 0};
    bool more = true;
    while (more) {
      ZSTD_outBuffer to{unpacked.data(), unpacked.size(), 0};
      open_frame = ZSTD_decompressStream(context.get(), &to, &from);
      if (ZSTD_isError(open_frame) != 0) return stopped = ZSTD_getErrorName(open_frame), Result{};
      if (std::fwrite(unpacked.data(), 1, to.pos, out) != to.pos)
        return tl::unexpected(std::string(std::strerror(errno)));
      more = from.pos < from.size || to.pos == to.size;
    }
    if (auto room = check_room(::fileno(out)); !room) return room;
  }
  if (std::ferror(in) != 0) return tl::unexpected(std::string("cannot be read to its end"));
  if (open_frame != 0) stopped = "cut off";
  return {};
}

}  // namespace

TemporaryFile::~TemporaryFile() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

tl::expected<TemporaryFile, std::string> unpack_file(const std::string& path,
                                                     std::vector<std::string>& warnings) {
  const File in(std::fopen(path.c_str(), "rb"));
  if (!in) return tl::unexpected(path + ": " + std::strerror(errno));
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "gvom-bag-XXXXXX").string();
  const int made = ::mkstemp(name.data());
  if (made < 0) return tl::unexpected(name + ": " + std::strerror(errno));
  TemporaryFile file(name);
  const File out(::fdopen(made, "wb"));
  std::string stopped;
  auto done = unpack_stream(in.get(), out.get(), stopped);
  if (done && std::fflush(out.get()) != 0) done = tl::unexpected(std::string(std::strerror(errno)));
  if (!done) return tl::unexpected(path + ": " + done.error());
  if (!stopped.empty())
    warnings.push_back(path + ": zstd: " + stopped + ": what was unpacked until then is read");
  return file;
}

void MessageUnpacker::Free::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

MessageUnpacker::MessageUnpacker() = default;
MessageUnpacker::~MessageUnpacker() = default;
MessageUnpacker::MessageUnpacker(MessageUnpacker&&) noexcept = default;
MessageUnpacker& MessageUnpacker::operator=(MessageUnpacker&&) noexcept = default;

Result MessageUnpacker::unpack(Bytes& data) {
  const bool packed =
      data.size >= kZstdMagic.size() && std::memcmp(data.data, kZstdMagic.data(), kZstdMagic.size()) == 0;
  if (!packed) return {};
  if (!context_) context_.reset(ZSTD_createDCtx());
  ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only);
  unpacked_.clear();
  ZSTD_inBuffer from{data.data, data.size, 0};
  std::size_t written = 0;
  for (std::size_t rest = 1; rest != 0;) {
    if (written == unpacked_.size()) unpacked_.resize(std::min(kMostMessageBytes, written * 2 + kPieceBytes));
    ZSTD_outBuffer to{unpacked_.data(), unpacked_.size(), written};
    rest = ZSTD_decompressStream(context_.get(), &to, &from);
    if (ZSTD_isError(rest) != 0) return tl::unexpected(std::string("zstd: ") + ZSTD_getErrorName(rest));
    const bool stands = to.pos == written && from.pos == from.size;
    written = to.pos;
    if (rest != 0 && stands) return tl::unexpected(std::string("zstd: cut off"));
    if (rest != 0 && written == kMostMessageBytes)
      return tl::unexpected(std::string("zstd: unpacks to too many bytes"));
  }
  data = {unpacked_.data(), written};
  return {};
}

}  // namespace gvom::bag
