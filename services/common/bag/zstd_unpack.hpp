// What rosbag2 packs by zstd: whole files, or messages one by one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/bag/bag_file.hpp"

struct ZSTD_DCtx_s;

namespace gvom::bag {

/// A file in the folder for temporary files that goes with this object.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string path) : path_(std::move(path)) {}
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Unpacks the file `path`. Frames before one that is damaged or cut off are kept, with a warning. Errors: it
/// can't be read, the disk has no room (256 MiB stay free).
tl::expected<TemporaryFile, std::string> unpack_file(const std::string& path,
                                                     std::vector<std::string>& warnings);

/// Messages that zstd packed, with a CDR head or whatever within; others are left as they are.
class MessageUnpacker {
 public:
  MessageUnpacker();
  ~MessageUnpacker();
  MessageUnpacker(MessageUnpacker&&) noexcept;
  MessageUnpacker& operator=(MessageUnpacker&&) noexcept;

  /// Replaces `data`, which is valid until the next call then. Errors: damaged, or over kMostMessageBytes.
  tl::expected<void, std::string> unpack(Bytes& data);

 private:
  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, Free> context_;
  std::vector<std::uint8_t> unpacked_;
};

}  // namespace gvom::bag
