// Writes MCAP files by the specification, also such as a killed recorder leaves.
#pragma once

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/support/cdr_writer.hpp"

namespace gvom::test {

struct McapLayout {
  std::string compression;         ///< "", "lz4", "zstd".
  std::size_t chunk_messages = 4;  ///< 0: no chunks.
  bool summary = true;
  bool crc = true;
};

class McapBuilder {
 public:
  explicit McapBuilder(McapLayout layout = {}) : layout_(layout) {
    file_ = magic();
    record(file_, 1, text("ros2") + text("test"));
  }

  /// Before the first message of it. Returns its channel.
  std::uint16_t topic(const std::string& name, const std::string& type, const std::string& encoding = "cdr") {
    const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
    Raw schema = number(id) + text(type) + text("ros2msg") + text("# no text");
    Raw channel = number(id) + number(id) + text(name) + text(encoding) + text("");
    Raw both;
    record(both, 3, schema);
    record(both, 4, channel);
    channels_[id] = both;
    target() += both;
    return id;
  }

  void add(std::uint16_t channel, std::int64_t log_ns, const std::vector<std::uint8_t>& data) {
    Raw body = number(channel) + number(std::uint32_t{0}) + number(log_ns) + number(log_ns - 1000);
    body.append(data.begin(), data.end());
    record(target(), 5, body);
    ++counts_[channel];
    if (layout_.chunk_messages == 0) return;
    open_channels_[channel] = 0;
    first_ns_ = open_messages_ == 0 ? log_ns : std::min(first_ns_, log_ns);
    last_ns_ = open_messages_ == 0 ? log_ns : std::max(last_ns_, log_ns);
    if (++open_messages_ == layout_.chunk_messages) close_chunk();
  }

  /// The bytes of the file. Chunk `n` is at `chunk_offset(n)`.
  std::string bytes() {
    if (open_messages_ > 0) close_chunk();
    Raw out = file_;
    record(out, 0x0F, number(std::uint32_t{0}));
    const std::uint64_t summary_at = out.size();
    if (layout_.summary) out += summary();
    Raw footer = number(layout_.summary ? summary_at : std::uint64_t{0}) + number(std::uint64_t{0});
    Raw covered = out.substr(summary_at) + '\x02' + number(std::uint64_t{20}) + footer;
    const std::uint32_t crc = layout_.crc && layout_.summary ? crc_of(covered) : 0;
    record(out, 2, footer + number(crc));
    return out + magic();
  }
  /// Writes the first `size` bytes, or all.
  void write(const std::string& path, std::size_t size = std::string::npos) {
    std::ofstream(path, std::ios::binary) << bytes().substr(0, size);
  }
  [[nodiscard]] std::uint64_t chunk_offset(std::size_t chunk) const { return chunk_offsets_.at(chunk); }
  [[nodiscard]] std::size_t chunk_bytes(std::size_t chunk) const { return chunk_sizes_.at(chunk); }

 private:
  using Raw = std::string;

  static Raw magic() { return Raw("\x89MCAP0\r\n", 8); }
  template <typename T>
  static Raw number(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  static Raw text(const std::string& text) { return number(static_cast<std::uint32_t>(text.size())) + text; }
  static void record(Raw& out, char opcode, const Raw& body) {
    out += opcode + number(static_cast<std::uint64_t>(body.size())) + body;
  }
  static std::uint32_t crc_of(const Raw& raw) {
    return static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const unsigned char*>(raw.data()), raw.size()));
  }
  Raw& target() { return layout_.chunk_messages == 0 ? file_ : open_; }

  [[nodiscard]] Raw packed(const Raw& raw) const {
    if (layout_.compression.empty()) return raw;
    const bool zstd = layout_.compression == "zstd";
    Raw out(zstd ? ZSTD_compressBound(raw.size()) : LZ4F_compressFrameBound(raw.size(), nullptr), 0);
    out.resize(zstd ? ZSTD_compress(out.data(), out.size(), raw.data(), raw.size(), 1)
                    : LZ4F_compressFrame(out.data(), out.size(), raw.data(), raw.size(), nullptr));
    return out;
  }

  void close_chunk() {
    const Raw body = number(first_ns_) + number(last_ns_) + number(std::uint64_t{open_.size()}) +
                     number(layout_.crc ? crc_of(open_) : 0u) + text(layout_.compression);
    const Raw records = packed(open_);
    chunk_offsets_.push_back(file_.size());
    record(file_, 6, body + number(std::uint64_t{records.size()}) + records);
    const std::uint64_t bytes = file_.size() - chunk_offsets_.back();
    chunk_sizes_.push_back(bytes);
    Raw offsets;
    for (const auto& [channel, unused] : open_channels_)
      offsets += number(channel) + number(std::uint64_t{file_.size()});
    Raw index;
    for (const auto& [channel, unused] : open_channels_) record(index, 7, number(channel) + number(0u));
    file_ += index;
    record(chunk_index_, 8,
           number(first_ns_) + number(last_ns_) + number(chunk_offsets_.back()) + number(bytes) +
               text(offsets) + number(std::uint64_t{index.size()}) + text(layout_.compression) +
               number(std::uint64_t{records.size()}) + number(std::uint64_t{open_.size()}));
    open_.clear();
    open_channels_.clear();
    open_messages_ = 0;
  }

  Raw summary() {
    Raw out;
    Raw counts;
    std::uint64_t messages = 0;
    for (const auto& [id, channel] : channels_) out += channel;
    for (const auto& [id, count] : counts_) {
      counts += number(id) + number(count);
      messages += count;
    }
    record(out, 0x0B,
           number(messages) + number(static_cast<std::uint16_t>(channels_.size())) +
               number(static_cast<std::uint32_t>(channels_.size())) + number(0u) + number(0u) +
               number(static_cast<std::uint32_t>(chunk_offsets_.size())) + number(std::int64_t{0}) +
               number(std::int64_t{0}) + text(counts));
    return out + chunk_index_;
  }

  McapLayout layout_;
  Raw file_;
  Raw open_;  // records of the chunk in the making
  std::map<std::uint16_t, Raw> channels_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::map<std::uint16_t, int> open_channels_;
  std::size_t open_messages_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  Raw chunk_index_;
  std::vector<std::uint64_t> chunk_offsets_;
  std::vector<std::uint64_t> chunk_sizes_;
};

}  // namespace gvom::test
