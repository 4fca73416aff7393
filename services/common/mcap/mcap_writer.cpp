#include "services/common/mcap/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>

#include "services/common/mcap/record_writer.hpp"

namespace gvom::mcap {
namespace {

constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'};
constexpr int kLevel = 1;

enum Record : std::uint8_t {
  kHeaderRecord = 1,
  kFooterRecord = 2,
  kSchemaRecord = 3,
  kChannelRecord = 4,
  kMessageRecord = 5,
  kChunkRecord = 6,
  kMessageIndexRecord = 7,
  kChunkIndexRecord = 8,
  kStatisticsRecord = 11,
  kSummaryOffsetRecord = 14,
  kDataEndRecord = 15,
};

std::uint32_t crc_of(const std::uint8_t* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes, size));
}

}  // namespace

void Writer::Span::add(std::uint64_t time_ns) {
  first_ns = empty ? time_ns : std::min(first_ns, time_ns);
  last_ns = empty ? time_ns : std::max(last_ns, time_ns);
  empty = false;
}

tl::expected<Writer, std::string> Writer::create(const std::string& path, const WriterOptions& options) {
  auto file = GrowingFile::create(path);
  if (!file) return tl::unexpected(file.error());
  Writer writer(std::move(*file), options);
  RecordWriter out(writer.out_);
  out.raw(kMagic, sizeof kMagic);
  out.begin(kHeaderRecord);
  out.text("ros2");
  out.text("gvom");
  out.end();
  if (const auto written = writer.file_.append(writer.out_); !written) return tl::unexpected(written.error());
  return writer;
}

std::uint16_t Writer::add_channel(const OutChannel& channel) {
  std::uint16_t schema = 0;
  if (!channel.type.empty()) {
    const auto known = std::find_if(schemas_.begin(), schemas_.end(),
                                    [&](const SchemaText& one) { return one.type == channel.type; });
    schema = static_cast<std::uint16_t>(known - schemas_.begin() + 1);
    if (known == schemas_.end()) schemas_.push_back({channel.type, channel.schema});
  }
  channels_.emplace_back(channel, false);
  schema_of_.push_back(schema);
  return static_cast<std::uint16_t>(channels_.size());
}

void Writer::put_schema(std::uint16_t id, std::vector<std::uint8_t>& into) {
  if (id == 0) return;
  RecordWriter out(into);
  out.begin(kSchemaRecord);
  out.number(id);
  out.text(schemas_[id - 1U].type);
  out.text("ros2msg");
  out.text(schemas_[id - 1U].text);
  out.end();
}

void Writer::put_channel(std::uint16_t id, std::vector<std::uint8_t>& into) {
  const OutChannel& channel = channels_[id - 1U].first;
  RecordWriter out(into);
  out.begin(kChannelRecord);
  out.number(id);
  out.number(schema_of_[id - 1U]);
  out.text(channel.topic);
  out.text(channel.encoding);
  std::map<std::string, std::string> metadata;
  if (!channel.offered_qos.empty()) metadata["offered_qos_profiles"] = channel.offered_qos;
  out.texts(metadata);
  out.end();
}

tl::expected<void, std::string> Writer::write(std::uint16_t channel, std::int64_t stamp_ns,
                                              const std::vector<std::uint8_t>& message) {
  if (!error_.empty()) return tl::unexpected(error_);
  if (bool& is_there = channels_[channel - 1U].second; !is_there) {
    put_schema(schema_of_[channel - 1U], chunk_);
    put_channel(channel, chunk_);
    is_there = true;
  }
  const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0));
  entries_[channel].push_back({time_ns, chunk_.size()});
  RecordWriter out(chunk_);
  out.begin(kMessageRecord);
  out.number(channel);
  out.number(static_cast<std::uint32_t>(messages_of_[channel]++));
  out.number(time_ns);
  out.number(time_ns);
  out.raw(message.data(), message.size());
  out.end();
  ++messages_;
  chunk_span_.add(time_ns);
  if (chunk_.size() < options_.chunk_bytes) return {};
  return flush();
}

tl::expected<void, std::string> Writer::pack_chunk() {
  if (options_.packing == Packing::none) {
    packed_ = chunk_;
    return {};
  }
  packed_.resize(ZSTD_compressBound(chunk_.size()));
  const std::size_t size =
      ZSTD_compress(packed_.data(), packed_.size(), chunk_.data(), chunk_.size(), kLevel);
  if (ZSTD_isError(size) != 0) return tl::unexpected(file_.path() + ": zstd: " + ZSTD_getErrorName(size));
  packed_.resize(size);
  return {};
}

Writer::ChunkPlace Writer::put_chunk(std::vector<std::uint8_t>& into) const {
  RecordWriter out(into);
  out.begin(kChunkRecord);
  out.number(chunk_span_.first_ns);
  out.number(chunk_span_.last_ns);
  out.number(std::uint64_t{chunk_.size()});
  out.number(crc_of(chunk_.data(), chunk_.size()));
  out.text(options_.packing == Packing::zstd ? "zstd" : "");
  out.number(std::uint64_t{packed_.size()});
  out.raw(packed_.data(), packed_.size());
  out.end();
  ChunkPlace place{chunk_span_, file_.size(), into.size(), packed_.size(), chunk_.size(), 0, {}};
  for (const auto& [channel, entries] : entries_) {
    place.indexes[channel] = file_.size() + into.size();
    out.begin(kMessageIndexRecord);
    out.number(channel);
    out.number(static_cast<std::uint32_t>(entries.size() * sizeof(IndexEntry)));
    for (const IndexEntry& entry : entries) {
      out.number(entry.time_ns);
      out.number(entry.offset);
    }
    out.end();
  }
  place.index_bytes = into.size() - place.bytes;
  return place;
}

tl::expected<void, std::string> Writer::flush() {
  if (!error_.empty()) return tl::unexpected(error_);
  if (chunk_.empty()) return {};
  auto done = pack_chunk();
  out_.clear();
  ChunkPlace place = put_chunk(out_);
  if (done) done = file_.append(out_);
  if (done) {
    span_.add(place.span.first_ns);
    span_.add(place.span.last_ns);
    chunks_.push_back(std::move(place));
  } else {
    error_ = done.error();
    for (const auto& [channel, entries] : entries_) {
      messages_ -= entries.size();
      messages_of_[channel] -= entries.size();
    }
  }
  chunk_.clear();
  chunk_span_ = {};
  entries_.clear();
  return done;
}

tl::expected<void, std::string> Writer::close() {
  auto done = flush();
  const auto finished = finish();
  const auto closed = file_.close();
  if (error_.empty()) error_ = file_.path() + ": it is closed";
  if (done) done = finished;
  return done ? closed : done;
}

tl::expected<void, std::string> Writer::finish() {
  out_.clear();
  RecordWriter out(out_);
  out.begin(kDataEndRecord);
  out.number(file_.crc());
  out.end();
  const std::size_t summary = out_.size();
  put_summary(out_, file_.size() + summary);
  out.number(crc_of(out_.data() + summary, out_.size() - summary));
  out.raw(kMagic, sizeof kMagic);
  return file_.append(out_);
}

/// All from the schemas on to the footer's checksum, which is left to the caller. `begin`: where the summary
/// begins in the file.
void Writer::put_summary(std::vector<std::uint8_t>& into, std::uint64_t begin) {
  const std::size_t offset = into.size();
  struct Group {
    std::uint8_t record;
    std::uint64_t begin, bytes;
  };
  std::vector<Group> groups;
  const auto group = [&](std::uint8_t record, auto put) {
    const std::size_t from = into.size();
    put();
    if (into.size() > from) groups.push_back({record, begin + from - offset, into.size() - from});
  };
  group(kSchemaRecord, [&] {
    for (std::size_t i = 0; i < schemas_.size(); ++i) put_schema(static_cast<std::uint16_t>(i + 1), into);
  });
  group(kChannelRecord, [&] {
    for (std::size_t i = 0; i < channels_.size(); ++i) put_channel(static_cast<std::uint16_t>(i + 1), into);
  });
  group(kStatisticsRecord, [&] { put_statistics(into); });
  group(kChunkIndexRecord, [&] { put_chunk_indexes(into); });
  RecordWriter out(into);
  const std::uint64_t offsets_begin = begin + into.size() - offset;
  for (const Group& one : groups) {
    out.begin(kSummaryOffsetRecord);
    out.number(one.record);
    out.number(one.begin);
    out.number(one.bytes);
    out.end();
  }
  out.number(std::uint8_t{kFooterRecord});
  out.number(std::uint64_t{20});
  out.number(begin);
  out.number(offsets_begin);
}

void Writer::put_statistics(std::vector<std::uint8_t>& into) const {
  RecordWriter out(into);
  out.begin(kStatisticsRecord);
  out.number(messages_);
  out.number(static_cast<std::uint16_t>(schemas_.size()));
  out.number(static_cast<std::uint32_t>(channels_.size()));
  out.number(std::uint32_t{0});  // attachments
  out.number(std::uint32_t{0});  // metadata
  out.number(static_cast<std::uint32_t>(chunks_.size()));
  out.number(span_.first_ns);
  out.number(span_.last_ns);
  out.numbers(messages_of_);
  out.end();
}

void Writer::put_chunk_indexes(std::vector<std::uint8_t>& into) const {
  RecordWriter out(into);
  for (const ChunkPlace& chunk : chunks_) {
    out.begin(kChunkIndexRecord);
    out.number(chunk.span.first_ns);
    out.number(chunk.span.last_ns);
    out.number(chunk.offset);
    out.number(chunk.bytes);
    out.numbers(chunk.indexes);
    out.number(chunk.index_bytes);
    out.text(options_.packing == Packing::zstd ? "zstd" : "");
    out.number(chunk.packed_bytes);
    out.number(chunk.unpacked_bytes);
    out.end();
  }
}

}  // namespace gvom::mcap
