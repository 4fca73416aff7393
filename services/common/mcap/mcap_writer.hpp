// Writes MCAP files of profile `ros2`: chunks, their indexes, a summary, checksums.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/mcap/growing_file.hpp"

namespace gvom::mcap {

enum class Packing { none, zstd };

struct WriterOptions {
  Packing packing = Packing::zstd;     ///< Level 1.
  std::size_t chunk_bytes = 1U << 20;  ///< A chunk is written when it has so many, unpacked.
};

/// A topic of a file.
struct OutChannel {
  std::string topic;
  std::string encoding;     ///< "cdr" or "json".
  std::string type;         ///< "nav_msgs/msg/OccupancyGrid"; empty: messages without a schema.
  std::string schema;       ///< The text of encoding `ros2msg`.
  std::string offered_qos;  ///< YAML, metadata `offered_qos_profiles`; empty: none.
};

class Writer {
 public:
  /// Makes the file; one of that name is replaced. Errors name the file and what the system says.
  static tl::expected<Writer, std::string> create(const std::string& path, const WriterOptions& options = {});

  /// For messages from now on; the same type has one schema, whose text is that of the first.
  std::uint16_t add_channel(const OutChannel& channel);

  /// Takes a copy of the message, both of whose times are `stamp_ns` (0 where it is before 1970). An error
  /// names the file and the reason, such as a full disk: what was in the file before stays whole, the chunk
  /// that did not fit is lost, and later messages are refused with the same words.
  tl::expected<void, std::string> write(std::uint16_t channel, std::int64_t stamp_ns,
                                        const std::vector<std::uint8_t>& message);

  /// Writes the chunk that is not full yet: what is kept if the process is killed now.
  tl::expected<void, std::string> flush();

  /// Writes the rest and the summary. Without it, or if it fails, a reader goes through the file in order. On
  /// a disk that was full it is tried all the same: a summary is small.
  tl::expected<void, std::string> close();

  /// Of the file, with what is not written yet (unpacked).
  [[nodiscard]] std::uint64_t bytes() const { return file_.size() + chunk_.size(); }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] const std::string& path() const { return file_.path(); }

 private:
  struct Span {
    std::uint64_t first_ns = 0, last_ns = 0;
    bool empty = true;
    void add(std::uint64_t time_ns);
  };
  struct ChunkPlace {
    Span span;
    std::uint64_t offset, bytes, packed_bytes, unpacked_bytes, index_bytes;
    std::map<std::uint16_t, std::uint64_t> indexes;  // where the message index of a channel is
  };
  struct IndexEntry {
    std::uint64_t time_ns, offset;
  };

  Writer(GrowingFile file, const WriterOptions& options) : file_(std::move(file)), options_(options) {}
  void put_channel(std::uint16_t id, std::vector<std::uint8_t>& into);
  void put_schema(std::uint16_t id, std::vector<std::uint8_t>& into);
  tl::expected<void, std::string> pack_chunk();
  ChunkPlace put_chunk(std::vector<std::uint8_t>& into) const;
  tl::expected<void, std::string> finish();
  void put_summary(std::vector<std::uint8_t>& into, std::uint64_t begin);
  void put_chunk_indexes(std::vector<std::uint8_t>& into) const;
  void put_statistics(std::vector<std::uint8_t>& into) const;

  GrowingFile file_;
  WriterOptions options_;
  std::string error_;  // what made it stop
  struct SchemaText {
    std::string type, text;
  };
  std::vector<SchemaText> schemas_;                     // id - 1
  std::vector<std::pair<OutChannel, bool>> channels_;   // id - 1; whether its records are in the file
  std::vector<std::uint16_t> schema_of_;                // of a channel; 0: none
  std::map<std::uint16_t, std::uint64_t> messages_of_;  // by channel
  std::uint64_t messages_ = 0;
  Span span_;
  std::vector<ChunkPlace> chunks_;

  std::vector<std::uint8_t> chunk_;   // records that are not written yet
  std::vector<std::uint8_t> packed_;  // the same, packed
  std::vector<std::uint8_t> out_;
  Span chunk_span_;
  std::map<std::uint16_t, std::vector<IndexEntry>> entries_;  // of the chunk
};

}  // namespace gvom::mcap
