// The messages of an MCAP file in order of their log times.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/mcap/mcap_index.hpp"

namespace gvom::mcap {

struct Message {
  const Channel* channel = nullptr;
  std::int64_t log_ns = 0;      ///< When the recorder got it.
  std::int64_t publish_ns = 0;  ///< When it was sent, if the recorder knew.
  Bytes data;                   ///< Valid until the next call.
};

/// Reads one chunk at a time, more only where they overlap in time. What is damaged is left out, counted and
/// named; the rest is read.
class McapReader {
 public:
  /// Errors: no such file, not an MCAP file. `name`: what it is called in them, if not by its path.
  static tl::expected<McapReader, std::string> open(const std::string& path, const std::string& name = "");

  /// All channels that have messages or were announced.
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const { return index_.channels; }
  /// Of all messages, by the log; both 0 where there is none.
  [[nodiscard]] std::int64_t first_ns() const;
  [[nodiscard]] std::int64_t last_ns() const;

  /// Only messages of these channels from now on, from the beginning.
  void select(const std::set<std::uint16_t>& channels);

  /// False at the end. Messages of one time come in the file's order. An error where chunks that overlap in
  /// time take more than 1 GiB.
  tl::expected<bool, std::string> next(Message& out);
  void rewind();

  [[nodiscard]] std::uint64_t damaged() const { return index_.damaged; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return index_.warnings; }

 private:
  struct Entry {
    std::int64_t log_ns;
    std::size_t at;  // of the message's body
    std::size_t bytes;
  };
  struct OpenBlock {
    std::vector<std::uint8_t> records;
    std::vector<Entry> entries;
    std::size_t next = 0;
  };
  struct Head {
    std::int64_t log_ns;
    std::size_t block;  // in index_.blocks, for ties
    std::unique_ptr<OpenBlock> open;
  };

  static bool is_later(const Head& a, const Head& b) {
    return std::tie(a.log_ns, a.block) > std::tie(b.log_ns, b.block);
  }

  McapReader(std::string name, RandomFile file) : name_(std::move(name)), file_(std::move(file)) {}
  [[nodiscard]] bool is_wanted(const Block& block) const;
  void push(std::size_t block, std::unique_ptr<OpenBlock> open);
  std::unique_ptr<OpenBlock> spare();
  tl::expected<void, std::string> open_block(std::size_t index);
  void load(const Block& block, OpenBlock& open);
  void note_entries(const Block& block, OpenBlock& open);
  void damaged(const Block& block, const std::string& reason);

  std::string name_;
  RandomFile file_;
  Unpacker unpacker_;
  Index index_;
  std::set<std::uint16_t> selected_;
  bool selects_ = false;
  std::size_t next_block_ = 0;
  std::vector<Head> heads_;          // a heap: the earliest first
  std::unique_ptr<OpenBlock> last_;  // what the last message points into
  std::size_t last_block_ = 0;
  std::vector<std::unique_ptr<OpenBlock>> spare_;
  std::uint64_t open_bytes_ = 0;
  std::vector<std::uint8_t> packed_;
  std::set<std::uint64_t> told_;  // offsets of damaged blocks
};

}  // namespace gvom::mcap
