#include "services/common/mcap/mcap_records.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace gvom::mcap {
namespace {

/// Little-endian fields in a row. After the first that is not there, all are 0 and `ok` is false.
class Fields {
 public:
  explicit Fields(Bytes rest) : rest_(rest) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return rest_.size; }

  template <typename T>
  T read() {
    T value{};
    const Bytes bytes = take(sizeof(T));
    if (bytes.data != nullptr) std::memcpy(&value, bytes.data, sizeof(T));
    return value;
  }

  std::int64_t time_ns() {
    constexpr std::uint64_t kLast = std::numeric_limits<std::int64_t>::max();
    return static_cast<std::int64_t>(std::min(read<std::uint64_t>(), kLast));
  }

  Bytes sized() { return take(read<std::uint32_t>()); }

  std::string text() {
    const Bytes bytes = sized();
    return {reinterpret_cast<const char*>(bytes.data), bytes.size};
  }

  std::map<std::uint16_t, std::uint64_t> counts() {
    std::map<std::uint16_t, std::uint64_t> out;
    Fields pairs(sized());
    while (ok_ && pairs.left() > 0) {
      const auto key = pairs.read<std::uint16_t>();
      out[key] = pairs.read<std::uint64_t>();
      ok_ = pairs.ok();
    }
    return out;
  }

 private:
  Bytes take(std::size_t size) {
    if (!ok_ || size > rest_.size) {
      ok_ = false;
      return {};
    }
    const Bytes taken{rest_.data, size};
    rest_ = {rest_.data + size, rest_.size - size};
    return taken;
  }

  Bytes rest_;
  bool ok_ = true;
};

template <typename T>
std::optional<T> if_ok(const Fields& fields, T value) {
  if (!fields.ok()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Record> take_record(Bytes& rest) {
  if (rest.size < kRecordHeadBytes) return std::nullopt;
  std::uint64_t length = 0;
  std::memcpy(&length, rest.data + 1, sizeof length);
  if (length > rest.size - kRecordHeadBytes) return std::nullopt;
  const Record record{rest.data[0], {rest.data + kRecordHeadBytes, static_cast<std::size_t>(length)}};
  const std::size_t taken = kRecordHeadBytes + record.body.size;
  rest = {rest.data + taken, rest.size - taken};
  return record;
}

std::optional<Schema> read_schema(Bytes body) {
  Fields fields(body);
  Schema schema;
  schema.id = fields.read<std::uint16_t>();
  schema.name = fields.text();
  return if_ok(fields, std::move(schema));
}

std::optional<ChannelRecord> read_channel(Bytes body) {
  Fields fields(body);
  ChannelRecord channel;
  channel.id = fields.read<std::uint16_t>();
  channel.schema_id = fields.read<std::uint16_t>();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  return if_ok(fields, std::move(channel));
}

std::optional<MessageHead> read_message_head(Bytes body) {
  Fields fields(body);
  MessageHead head;
  head.channel_id = fields.read<std::uint16_t>();
  fields.read<std::uint32_t>();  // sequence
  head.log_ns = fields.time_ns();
  head.publish_ns = fields.time_ns();
  return if_ok(fields, head);
}

std::optional<ChunkHead> read_chunk_head(Bytes body) {
  Fields fields(body);
  ChunkHead head;
  head.first_ns = fields.time_ns();
  head.last_ns = fields.time_ns();
  head.bytes = fields.read<std::uint64_t>();
  head.crc = fields.read<std::uint32_t>();
  head.compression = fields.text();
  head.packed_bytes = fields.read<std::uint64_t>();
  head.head_bytes = body.size - fields.left();
  return if_ok(fields, std::move(head));
}

std::optional<ChunkIndex> read_chunk_index(Bytes body) {
  Fields fields(body);
  ChunkIndex index;
  index.first_ns = fields.time_ns();
  index.last_ns = fields.time_ns();
  index.offset = fields.read<std::uint64_t>();
  index.bytes = fields.read<std::uint64_t>();
  index.channels = fields.counts();
  index.message_index_bytes = fields.read<std::uint64_t>();
  return if_ok(fields, std::move(index));
}

std::optional<Statistics> read_statistics(Bytes body) {
  Fields fields(body);
  Statistics statistics;
  statistics.messages = fields.read<std::uint64_t>();
  fields.read<std::uint16_t>();                              // schemas
  for (int i = 0; i < 3; ++i) fields.read<std::uint32_t>();  // channels, attachments, metadata
  statistics.chunks = fields.read<std::uint32_t>();
  for (int i = 0; i < 2; ++i) fields.time_ns();  // first, last
  statistics.messages_of = fields.counts();
  return if_ok(fields, std::move(statistics));
}

}  // namespace gvom::mcap
