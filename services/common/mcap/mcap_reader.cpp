#include "services/common/mcap/mcap_reader.hpp"

#include <algorithm>
#include <utility>

namespace gvom::mcap {
namespace {

constexpr std::uint64_t kMostOpenBytes = 1 << 30;

}  // namespace

tl::expected<McapReader, std::string> McapReader::open(const std::string& path, const std::string& name) {
  auto file = RandomFile::open(path);
  if (!file) return tl::unexpected(file.error());
  McapReader reader(name.empty() ? path : name, std::move(*file));
  auto index = make_index(reader.file_, reader.name_, reader.unpacker_);
  if (!index) return tl::unexpected(index.error());
  reader.index_ = std::move(*index);
  return reader;
}

std::int64_t McapReader::first_ns() const {
  return index_.blocks.empty() ? 0 : index_.blocks.front().first_ns;
}

std::int64_t McapReader::last_ns() const {
  std::int64_t last_ns = first_ns();
  for (const Block& block : index_.blocks) last_ns = std::max(last_ns, block.last_ns);
  return last_ns;
}

void McapReader::select(const std::set<std::uint16_t>& channels) {
  selected_ = channels;
  selects_ = true;
  rewind();
}

void McapReader::rewind() {
  for (Head& head : heads_) spare_.push_back(std::move(head.open));
  heads_.clear();
  if (last_) spare_.push_back(std::move(last_));
  next_block_ = 0;
  open_bytes_ = 0;
}

bool McapReader::is_wanted(const Block& block) const {
  if (!selects_ || !block.knows_channels) return true;
  return std::any_of(block.channels.begin(), block.channels.end(),
                     [this](std::uint16_t id) { return selected_.count(id) != 0; });
}

tl::expected<bool, std::string> McapReader::next(Message& out) {
  if (last_) push(last_block_, std::move(last_));
  const auto& blocks = index_.blocks;
  while (next_block_ < blocks.size() &&
         (heads_.empty() || blocks[next_block_].first_ns <= heads_.front().log_ns)) {
    const std::size_t index = next_block_++;
    if (!is_wanted(blocks[index])) continue;
    const auto opened = open_block(index);
    if (!opened) return tl::unexpected(opened.error());
  }
  if (heads_.empty()) return false;
  std::pop_heap(heads_.begin(), heads_.end(), is_later);
  last_block_ = heads_.back().block;
  last_ = std::move(heads_.back().open);
  heads_.pop_back();
  const Entry& entry = last_->entries[last_->next++];
  const Bytes body{last_->records.data() + entry.at, entry.bytes};
  const MessageHead head = *read_message_head(body);
  out = {&index_.channels.at(head.channel_id),
         head.log_ns,
         head.publish_ns,
         {body.data + kMessageHeadBytes, body.size - kMessageHeadBytes}};
  return true;
}

void McapReader::push(std::size_t block, std::unique_ptr<OpenBlock> open) {
  if (open->next == open->entries.size()) {
    open_bytes_ -= open->records.size();
    spare_.push_back(std::move(open));
    return;
  }
  const std::int64_t log_ns = open->entries[open->next].log_ns;
  heads_.push_back({log_ns, block, std::move(open)});
  std::push_heap(heads_.begin(), heads_.end(), is_later);
}

tl::expected<void, std::string> McapReader::open_block(std::size_t index) {
  const Block& block = index_.blocks[index];
  auto open = spare();
  load(block, *open);
  open_bytes_ += open->records.size();
  if (open_bytes_ > kMostOpenBytes) {
    return tl::unexpected(
        name_ + ": chunk at byte " + std::to_string(block.offset) +
        ": its messages and those of others before it are of the same times, over 1 GiB of them: "
        "sort the file by time first");
  }
  push(index, std::move(open));
  return {};
}

std::unique_ptr<McapReader::OpenBlock> McapReader::spare() {
  if (spare_.empty()) return std::make_unique<OpenBlock>();
  auto open = std::move(spare_.back());
  spare_.pop_back();
  open->records.clear();
  open->entries.clear();
  open->next = 0;
  return open;
}

/// Leaves `open` empty where the block is damaged.
void McapReader::load(const Block& block, OpenBlock& open) {
  if (!block.is_chunk) {
    if (!file_.read(block.offset, block.bytes, open.records)) damaged(block, "cannot be read");
    return note_entries(block, open);
  }
  const bool read =
      block.bytes <= kRecordHeadBytes + kMostBytes && file_.read(block.offset, block.bytes, packed_);
  Bytes rest{packed_.data(), read ? packed_.size() : 0};
  const auto record = take_record(rest);
  if (!record || record->opcode != kChunk) return damaged(block, "there is none");
  const auto unpacked = unpacker_.unpack(record->body, open.records);
  if (!unpacked) {
    open.records.clear();
    return damaged(block, unpacked.error());
  }
  note_entries(block, open);
}

void McapReader::note_entries(const Block& block, OpenBlock& open) {
  Bytes rest{open.records.data(), open.records.size()};
  while (const auto record = take_record(rest)) {
    if (record->opcode != kMessage) continue;
    const auto head = read_message_head(record->body);
    const bool known = head && index_.channels.count(head->channel_id) != 0;
    if (!known) damaged(block, "a message of it is damaged");
    if (!known || (selects_ && selected_.count(head->channel_id) == 0)) continue;
    const auto at = static_cast<std::size_t>(record->body.data - open.records.data());
    open.entries.push_back({head->log_ns, at, record->body.size});
  }
  if (rest.size > 0) damaged(block, "its last " + std::to_string(rest.size) + " bytes, which are no record");
  std::stable_sort(open.entries.begin(), open.entries.end(),
                   [](const Entry& a, const Entry& b) { return a.log_ns < b.log_ns; });
}

/// Once, however often the file is read.
void McapReader::damaged(const Block& block, const std::string& reason) {
  if (!told_.insert(block.offset).second) return;
  if (++index_.damaged > kMostTold) return;
  index_.warnings.push_back(name_ + ": chunk at byte " + std::to_string(block.offset) + ": " + reason +
                            ": left out");
}

}  // namespace gvom::mcap
