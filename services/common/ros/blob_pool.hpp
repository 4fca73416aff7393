// Memory for messages that is used again.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "services/common/ros/blob.hpp"

namespace gvom::ros {

/// Hands out buffers that nobody holds any more; makes one where all are held. Of one thread; the blobs made
/// of its buffers may be let go by any.
class BlobPool {
 public:
  using Buffer = std::shared_ptr<std::vector<std::uint8_t>>;

  /// Holds what an earlier message left in it. Once it is handed on as a Blob it is not written again.
  Buffer take() {
    for (const Buffer& buffer : buffers_)
      if (buffer.use_count() == 1) return buffer;
    buffers_.push_back(std::make_shared<std::vector<std::uint8_t>>());
    return buffers_.back();
  }

  [[nodiscard]] std::size_t size() const { return buffers_.size(); }

 private:
  std::vector<Buffer> buffers_;
};

}  // namespace gvom::ros
