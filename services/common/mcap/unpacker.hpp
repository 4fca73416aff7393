// The records of a chunk, out of whatever they are packed by.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/mcap/mcap_records.hpp"

struct LZ4F_dctx_s;
struct ZSTD_DCtx_s;

namespace gvom::mcap {

class Unpacker {
 public:
  Unpacker();
  ~Unpacker();
  Unpacker(Unpacker&&) noexcept;
  Unpacker& operator=(Unpacker&&) noexcept;

  /// `chunk`: the body of a chunk's record. Fills `out` with its records. Errors: cut, of an unknown
  /// compression, above kMostBytes, damaged, or the CRC is another.
  tl::expected<void, std::string> unpack(Bytes chunk, std::vector<std::uint8_t>& out);

 private:
  tl::expected<void, std::string> unpack_zstd(Bytes packed, std::vector<std::uint8_t>& out);
  tl::expected<void, std::string> unpack_lz4(Bytes packed, std::vector<std::uint8_t>& out);

  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
    void operator()(LZ4F_dctx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, Free> zstd_;
  std::unique_ptr<LZ4F_dctx_s, Free> lz4_;
};

}  // namespace gvom::mcap
