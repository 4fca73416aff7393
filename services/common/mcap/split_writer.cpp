#include "services/common/mcap/split_writer.hpp"

#include <cstdio>

namespace gvom::mcap {

std::uint16_t SplitWriter::add_channel(const OutChannel& channel) {
  channels_.push_back(channel);
  return static_cast<std::uint16_t>(channels_.size());
}

tl::expected<void, std::string> SplitWriter::open_next() {
  char number[16];
  std::snprintf(number, sizeof number, "_%03d", files_);
  auto writer = Writer::create(stem_ + number + ".mcap", options_);
  if (!writer) return tl::unexpected(writer.error());
  writer_.emplace(std::move(*writer));
  for (const OutChannel& channel : channels_) writer_->add_channel(channel);
  ++files_;
  return {};
}

tl::expected<void, std::string> SplitWriter::write(std::uint16_t channel, std::int64_t stamp_ns,
                                                   const std::vector<std::uint8_t>& message) {
  if (writer_ && writer_->bytes() >= most_bytes_)
    if (auto closed = close(); !closed) return closed;
  if (!writer_)
    if (auto opened = open_next(); !opened) return opened;
  return writer_->write(channel, stamp_ns, message);
}

tl::expected<void, std::string> SplitWriter::flush() {
  return writer_ ? writer_->flush() : tl::expected<void, std::string>{};
}

tl::expected<void, std::string> SplitWriter::close() {
  if (!writer_) return {};
  auto closed = writer_->close();
  writer_.reset();
  return closed;
}

}  // namespace gvom::mcap
