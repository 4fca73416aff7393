// Where an MCAP file has which messages.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/mcap/mcap_records.hpp"
#include "services/common/mcap/random_file.hpp"
#include "services/common/mcap/unpacker.hpp"

namespace gvom::mcap {

/// Damaged pieces that are named; more are counted only.
inline constexpr std::uint64_t kMostTold = 20;

struct Channel {
  std::uint16_t id = 0;
  std::string topic;
  std::string type;      ///< The schema's name: "nav_msgs/msg/Odometry".
  std::string encoding;  ///< Of the messages: "cdr".
  std::uint64_t messages = 0;
};

/// A piece of the file that is read at once: a chunk, or messages in a row that are in no chunk.
struct Block {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  bool is_chunk = false;
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  bool knows_channels = false;
  std::vector<std::uint16_t> channels;  ///< In it, if that is known; in order.
};

struct Index {
  std::map<std::uint16_t, Channel> channels;
  std::vector<Block> blocks;  ///< In order of their first times.
  bool from_summary = false;
  std::uint64_t damaged = 0;  ///< Chunks, or ends of files, of which messages are left out.
  std::vector<std::string> warnings;
};

/// Adds a channel or schema to `index`; true if `record` is one.
class ChannelNotes {
 public:
  explicit ChannelNotes(Index& index) : index_(index) {}
  bool take(const Record& record);

 private:
  Index& index_;
  std::map<std::uint16_t, std::string> schemas_;
};

/// By the file's summary, or without one (its recorder was killed) by a look at the whole file. What is
/// damaged or cut off is left out, and told. An error if it is no MCAP file at all.
tl::expected<Index, std::string> make_index(RandomFile& file, const std::string& path, Unpacker& unpacker);

}  // namespace gvom::mcap
