#include "services/common/mcap/mcap_index.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace gvom::mcap {
namespace {

constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kMagicBytes = sizeof kMagic;
constexpr std::size_t kFooterBytes = kRecordHeadBytes + 20;
constexpr std::uint64_t kRunBytes = 4 << 20;  // messages without a chunk that are read at once
constexpr std::size_t kPeekBytes = kRecordHeadBytes + kMessageHeadBytes;

bool is_magic(Bytes bytes) {
  return bytes.size == kMagicBytes && std::memcmp(bytes.data, kMagic, kMagicBytes) == 0;
}

std::string at(std::uint64_t offset) {
  return "byte " + std::to_string(offset);
}

void widen(Block& block, std::int64_t time_ns) {
  block.first_ns = std::min(block.first_ns, time_ns);
  block.last_ns = std::max(block.last_ns, time_ns);
}

/// Looks at the records outside of chunks, from one place of the file to another.
class Scan {
 public:
  /// With `into_chunks` chunks are opened for their channels and counts.
  Scan(RandomFile& file, const std::string& path, Unpacker& unpacker, Index& index, bool into_chunks)
      : file_(file),
        path_(path),
        unpacker_(unpacker),
        index_(index),
        notes_(index),
        into_chunks_(into_chunks) {}

  /// True if the records end at `end`, or at the file's own mark before it.
  bool run(std::uint64_t from, std::uint64_t end) {
    while (from < end && !data_ended_) {
      const Bytes head = file_.peek(from, kPeekBytes);
      std::uint64_t length = 0;
      if (head.size >= kRecordHeadBytes) std::memcpy(&length, head.data + 1, sizeof length);
      if (head.size < kRecordHeadBytes || length > end - from - kRecordHeadBytes) {
        close_run();
        stopped_at_ = from;
        return false;
      }
      take(head, from, length);
      from += kRecordHeadBytes + length;
    }
    close_run();
    return true;
  }

  [[nodiscard]] std::uint64_t stopped_at() const { return stopped_at_; }

 private:
  void take(Bytes head, std::uint64_t from, std::uint64_t length) {
    const std::uint8_t opcode = head.data[0];
    if (opcode == kMessage) return add_message(head, from, length);
    close_run();
    data_ended_ = opcode == kDataEnd || opcode == kFooter;
    if (opcode != kChunk && opcode != kSchema && opcode != kChannel) return;
    if (length > kMostBytes || !file_.read(from, kRecordHeadBytes + length, record_))
      return damaged(opcode == kChunk ? "chunk" : "record", from, std::to_string(length) + " bytes");
    const Bytes body{record_.data() + kRecordHeadBytes, static_cast<std::size_t>(length)};
    if (opcode == kChunk) return add_chunk(body, from);
    if (!notes_.take({opcode, body})) damaged("channel or schema", from, "it is damaged");
  }

  void add_message(Bytes head, std::uint64_t from, std::uint64_t length) {
    const auto message =
        read_message_head({head.data + kRecordHeadBytes, std::min(head.size - kRecordHeadBytes, length)});
    if (!message || length > kMostBytes) {
      close_run();
      return damaged("message", from, std::to_string(length) + " bytes");
    }
    if (run_.bytes + length > kRunBytes) close_run();
    if (run_.bytes == 0) run_.offset = from;
    run_.bytes += kRecordHeadBytes + length;
    widen(run_, message->log_ns);
    ++counts_into(*message);
  }

  void close_run() {
    if (run_.bytes > 0) index_.blocks.push_back(run_);
    run_ = {};
  }

  void add_chunk(Bytes body, std::uint64_t from) {
    if (!into_chunks_) return;
    const auto unpacked = unpacker_.unpack(body, records_);
    if (!unpacked) return damaged("chunk", from, unpacked.error());
    Block block;
    block.offset = from;
    block.bytes = kRecordHeadBytes + body.size;
    block.is_chunk = true;
    Bytes rest{records_.data(), records_.size()};
    while (const auto record = take_record(rest)) {
      if (notes_.take(*record) || record->opcode != kMessage) continue;
      const auto message = read_message_head(record->body);
      if (!message) continue;  // told when the chunk is read
      widen(block, message->log_ns);
      ++counts_into(*message);
    }
    if (block.first_ns <= block.last_ns) index_.blocks.push_back(block);
  }

  std::uint64_t& counts_into(const MessageHead& message) {
    Channel& channel = index_.channels[message.channel_id];
    channel.id = message.channel_id;
    return channel.messages;
  }

  void damaged(const char* what, std::uint64_t from, const std::string& reason) {
    if (++index_.damaged > kMostTold) return;
    index_.warnings.push_back(path_ + ": " + what + " at " + at(from) + ": " + reason + ": left out");
  }

  RandomFile& file_;
  const std::string& path_;
  Unpacker& unpacker_;
  Index& index_;
  ChannelNotes notes_;
  bool into_chunks_;
  bool data_ended_ = false;
  std::uint64_t stopped_at_ = 0;
  Block run_;
  std::vector<std::uint8_t> record_;
  std::vector<std::uint8_t> records_;
};

struct Summary {
  std::vector<ChunkIndex> chunks;
  std::optional<Statistics> statistics;
  std::uint64_t start = 0;
};

/// The bytes of the summary and the footer; nothing if there is none, or its CRC is wrong.
std::optional<std::vector<std::uint8_t>> read_summary_bytes(RandomFile& file, std::uint64_t& start) {
  if (file.size() < 2 * kMagicBytes + kFooterBytes) return std::nullopt;
  const std::uint64_t footer_at = file.size() - kMagicBytes - kFooterBytes;
  const Bytes footer = file.peek(footer_at, kFooterBytes);
  if (footer.size != kFooterBytes || footer.data[0] != kFooter) return std::nullopt;
  std::uint32_t crc = 0;
  std::memcpy(&start, footer.data + kRecordHeadBytes, sizeof start);
  std::memcpy(&crc, footer.data + kFooterBytes - sizeof crc, sizeof crc);
  if (start < kMagicBytes || start >= footer_at || footer_at - start > kMostBytes) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  if (!file.read(start, footer_at - start + kFooterBytes, bytes)) return std::nullopt;
  const std::size_t covered = bytes.size() - sizeof crc;
  if (crc != 0 && ::crc32_z(0, bytes.data(), covered) != crc) return std::nullopt;
  bytes.resize(bytes.size() - kFooterBytes);
  return bytes;
}

/// Nothing if there is none, or it does not say where all chunks are.
std::optional<Summary> read_summary(RandomFile& file, Index& index) {
  Summary summary;
  const auto bytes = read_summary_bytes(file, summary.start);
  if (!bytes) return std::nullopt;
  ChannelNotes notes(index);
  Bytes rest{bytes->data(), bytes->size()};
  while (const auto record = take_record(rest)) {
    if (notes.take(*record)) continue;
    if (record->opcode == kStatistics) summary.statistics = read_statistics(record->body);
    if (record->opcode != kChunkIndex) continue;
    auto chunk = read_chunk_index(record->body);
    if (!chunk || chunk->offset >= summary.start || chunk->bytes > summary.start - chunk->offset)
      return std::nullopt;
    summary.chunks.push_back(std::move(*chunk));
  }
  const bool whole = rest.size == 0 && summary.statistics &&
                     summary.statistics->chunks == summary.chunks.size() && !index.channels.empty();
  if (!whole) return std::nullopt;
  for (const auto& [id, count] : summary.statistics->messages_of)
    if (index.channels.count(id) == 0) return std::nullopt;
  return summary;
}

Block block_of(const ChunkIndex& chunk) {
  Block block{chunk.offset, chunk.bytes, true, chunk.first_ns, chunk.last_ns, !chunk.channels.empty(), {}};
  for (const auto& [id, where] : chunk.channels) block.channels.push_back(id);
  return block;
}

/// Chunks are where the summary says; between them messages may be that are in no chunk.
bool index_by_summary(RandomFile& file, const std::string& path, Unpacker& unpacker, Index& index) {
  auto summary = read_summary(file, index);
  if (!summary) return false;
  auto& chunks = summary->chunks;
  std::sort(chunks.begin(), chunks.end(),
            [](const ChunkIndex& a, const ChunkIndex& b) { return a.offset < b.offset; });
  Scan between(file, path, unpacker, index, false);
  std::uint64_t from = kMagicBytes;
  for (const ChunkIndex& chunk : chunks) {
    const std::uint64_t end = chunk.offset + chunk.bytes;
    if (chunk.offset < from || chunk.message_index_bytes > summary->start - end) return false;
    if (!between.run(from, chunk.offset)) return false;
    index.blocks.push_back(block_of(chunk));
    from = end + chunk.message_index_bytes;
  }
  if (!between.run(from, summary->start)) return false;
  for (auto& [id, channel] : index.channels) channel.messages = summary->statistics->messages_of[id];
  index.from_summary = true;
  return true;
}

void index_by_scan(RandomFile& file, const std::string& path, Unpacker& unpacker, Index& index) {
  const bool has_end =
      file.size() >= 2 * kMagicBytes && is_magic(file.peek(file.size() - kMagicBytes, kMagicBytes));
  index.warnings.push_back(path +
                           (has_end ? ": has no summary that could be used: the whole file was looked through"
                                    : ": was not closed by its recorder: the whole file was looked through"));
  Scan scan(file, path, unpacker, index, true);
  if (scan.run(kMagicBytes, file.size() - (has_end ? kMagicBytes : 0))) return;
  ++index.damaged;
  index.warnings.push_back(path + ": cut off, or damaged, at " + at(scan.stopped_at()) + ": the last " +
                           std::to_string(file.size() - scan.stopped_at()) + " bytes are left out");
}

}  // namespace

bool ChannelNotes::take(const Record& record) {
  if (record.opcode == kSchema) {
    const auto schema = read_schema(record.body);
    if (schema) schemas_[schema->id] = schema->name;
    return schema.has_value();
  }
  if (record.opcode != kChannel) return false;
  const auto read = read_channel(record.body);
  if (!read) return false;
  Channel& channel = index_.channels[read->id];
  channel.id = read->id;
  channel.topic = read->topic;
  const auto schema = schemas_.find(read->schema_id);
  if (schema != schemas_.end()) channel.type = schema->second;
  channel.encoding = read->encoding;
  return true;
}

tl::expected<Index, std::string> make_index(RandomFile& file, const std::string& path, Unpacker& unpacker) {
  if (!is_magic(file.peek(0, kMagicBytes))) return tl::unexpected(path + ": is no MCAP file");
  Index index;
  if (!index_by_summary(file, path, unpacker, index)) {
    index = {};
    index_by_scan(file, path, unpacker, index);
  }
  std::stable_sort(index.blocks.begin(), index.blocks.end(),
                   [](const Block& a, const Block& b) { return a.first_ns < b.first_ns; });
  return index;
}

}  // namespace gvom::mcap
