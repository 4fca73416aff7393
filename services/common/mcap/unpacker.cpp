#include "services/common/mcap/unpacker.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace gvom::mcap {
namespace {

/// What `packed` bytes can unpack to at most, by the formats' densest blocks.
std::uint64_t most_bytes(const std::string& compression, std::size_t packed) {
  constexpr std::uint64_t kZstdRatio = 32768;
  constexpr std::uint64_t kLz4Ratio = 255;
  return std::uint64_t{packed} * (compression == "zstd" ? kZstdRatio : kLz4Ratio);
}

}  // namespace

void Unpacker::Free::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

void Unpacker::Free::operator()(LZ4F_dctx_s* context) const {
  LZ4F_freeDecompressionContext(context);
}

Unpacker::Unpacker() = default;
Unpacker::~Unpacker() = default;
Unpacker::Unpacker(Unpacker&&) noexcept = default;
Unpacker& Unpacker::operator=(Unpacker&&) noexcept = default;

tl::expected<void, std::string> Unpacker::unpack(Bytes chunk, std::vector<std::uint8_t>& out) {
  const auto head = read_chunk_head(chunk);
  if (!head || head->packed_bytes > chunk.size - head->head_bytes)
    return tl::unexpected(std::string("its record is damaged"));
  const bool plain = head->compression.empty();
  if (head->bytes > kMostBytes || (!plain && head->bytes > most_bytes(head->compression, head->packed_bytes)))
    return tl::unexpected("it says that it unpacks to " + std::to_string(head->bytes) + " bytes");
  const Bytes packed{chunk.data + head->head_bytes, static_cast<std::size_t>(head->packed_bytes)};
  if (plain && packed.size != head->bytes) return tl::unexpected(std::string("its two sizes differ"));
  if (plain) {
    out.assign(packed.data, packed.data + packed.size);
  } else {
    out.resize(static_cast<std::size_t>(head->bytes));
    tl::expected<void, std::string> done;
    if (head->compression == "zstd") {
      done = unpack_zstd(packed, out);
    } else if (head->compression == "lz4") {
      done = unpack_lz4(packed, out);
    } else {
      done = tl::unexpected("it is packed by '" + head->compression.substr(0, 40) + "', which is not known");
    }
    if (!done) return done;
  }
  if (head->crc != 0 && ::crc32_z(0, out.data(), out.size()) != head->crc)
    return tl::unexpected(std::string("its CRC is wrong"));
  return {};
}

tl::expected<void, std::string> Unpacker::unpack_zstd(Bytes packed, std::vector<std::uint8_t>& out) {
  if (!zstd_) zstd_.reset(ZSTD_createDCtx());
  const std::size_t got = ZSTD_decompressDCtx(zstd_.get(), out.data(), out.size(), packed.data, packed.size);
  if (ZSTD_isError(got) != 0) return tl::unexpected(std::string("zstd: ") + ZSTD_getErrorName(got));
  if (got != out.size()) return tl::unexpected(std::string("zstd: fewer bytes than it says"));
  return {};
}

tl::expected<void, std::string> Unpacker::unpack_lz4(Bytes packed, std::vector<std::uint8_t>& out) {
  if (!lz4_) {
    LZ4F_dctx* context = nullptr;
    LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
    lz4_.reset(context);
  }
  LZ4F_resetDecompressionContext(lz4_.get());
  std::size_t written = 0;
  std::size_t used = 0;
  for (;;) {
    std::size_t room = out.size() - written;
    std::size_t some = packed.size - used;
    const std::size_t hint =
        LZ4F_decompress(lz4_.get(), out.data() + written, &room, packed.data + used, &some, nullptr);
    if (LZ4F_isError(hint) != 0) return tl::unexpected(std::string("lz4: ") + LZ4F_getErrorName(hint));
    written += room;
    used += some;
    if (hint == 0 && written == out.size()) return {};
    if (hint == 0 || (room == 0 && some == 0))
      return tl::unexpected(std::string("lz4: another size than it says"));
  }
}

}  // namespace gvom::mcap
