// One recording in several MCAP files, a new one when a size is reached.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/common/mcap/mcap_writer.hpp"

namespace gvom::mcap {

class SplitWriter {
 public:
  /// Files are `STEM_000.mcap`, `STEM_001.mcap`, ...: each has what a reader needs. `most_bytes`: of one; a
  /// message more may be in it. The first is made with the first message.
  SplitWriter(std::string stem, std::uint64_t most_bytes, const WriterOptions& options = {})
      : stem_(std::move(stem)), most_bytes_(most_bytes), options_(options) {}

  /// Before the first message.
  std::uint16_t add_channel(const OutChannel& channel);

  /// As Writer's.
  tl::expected<void, std::string> write(std::uint16_t channel, std::int64_t stamp_ns,
                                        const std::vector<std::uint8_t>& message);
  tl::expected<void, std::string> flush();
  tl::expected<void, std::string> close();

  [[nodiscard]] int files() const { return files_; }

 private:
  tl::expected<void, std::string> open_next();

  std::string stem_;
  std::uint64_t most_bytes_;
  WriterOptions options_;
  std::vector<OutChannel> channels_;
  std::optional<Writer> writer_;
  int files_ = 0;
};

}  // namespace gvom::mcap
