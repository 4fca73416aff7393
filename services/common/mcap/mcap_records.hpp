// What the records of an MCAP file say, read from bytes that nobody vouches for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "services/common/ros/cdr_reader.hpp"

namespace gvom::mcap {

using ros::Bytes;

enum Opcode : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F,
};

inline constexpr std::size_t kRecordHeadBytes = 9;      // opcode, length
inline constexpr std::size_t kMessageHeadBytes = 22;    // channel, sequence, two times
inline constexpr std::uint64_t kMostBytes = 512 << 20;  // of a chunk, packed or not, and of any other record

struct Record {
  std::uint8_t opcode = 0;
  Bytes body;
};

/// Takes the record at `rest`'s front off it; nothing if there is no whole one.
std::optional<Record> take_record(Bytes& rest);

struct Schema {
  std::uint16_t id = 0;
  std::string name;
};

struct ChannelRecord {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic;
  std::string encoding;
};

struct MessageHead {
  std::uint16_t channel_id = 0;
  std::int64_t log_ns = 0;
  std::int64_t publish_ns = 0;
};

/// Without the packed records, which are the `packed_bytes` behind the head's `head_bytes`.
struct ChunkHead {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t bytes = 0;  ///< Unpacked.
  std::uint32_t crc = 0;    ///< 0: not known.
  std::string compression;
  std::uint64_t packed_bytes = 0;
  std::size_t head_bytes = 0;
};

struct ChunkIndex {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t offset = 0;                         ///< Of the chunk's record in the file.
  std::uint64_t bytes = 0;                          ///< Of the chunk's record, with its head.
  std::map<std::uint16_t, std::uint64_t> channels;  ///< Where the message index of each is.
  std::uint64_t message_index_bytes = 0;            ///< Of the records that follow the chunk.
};

struct Statistics {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
  std::map<std::uint16_t, std::uint64_t> messages_of;  ///< By channel.
};

/// Times beyond the year 2262 are taken as that. All: nothing where the body is not such a record.
std::optional<Schema> read_schema(Bytes body);
std::optional<ChannelRecord> read_channel(Bytes body);
std::optional<MessageHead> read_message_head(Bytes body);
std::optional<ChunkHead> read_chunk_head(Bytes body);
std::optional<ChunkIndex> read_chunk_index(Bytes body);
std::optional<Statistics> read_statistics(Bytes body);

}  // namespace gvom::mcap
