// Reads an MCAP file in order, slowly, checking each length and checksum: the writer's code is not in it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace gvom::test {

struct McapMessage {
  std::string topic;
  std::string type;  ///< Empty: without a schema.
  std::uint64_t log_ns;
  std::vector<std::uint8_t> bytes;
};

struct McapFile {
  std::string profile;
  std::vector<McapMessage> messages;            ///< In the order in which they were written.
  std::map<std::string, std::string> schemas;   ///< By type.
  std::map<std::string, std::string> metadata;  ///< offered_qos_profiles by topic.
  std::size_t chunks = 0;
  bool finished = false;           ///< Footer and magic are there.
  std::uint64_t counted = 0;       ///< Messages by the statistics.
  std::size_t indexed_chunks = 0;  ///< Whose index leads to a chunk and to its messages.
  std::size_t bytes_behind = 0;    ///< Behind the last whole record: of a recorder that was killed.
};

/// Fails the test where the file is not as MCAP's specification has it.
McapFile read_mcap(const std::string& path);

}  // namespace gvom::test
