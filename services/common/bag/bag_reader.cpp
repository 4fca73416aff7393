#include "services/common/bag/bag_reader.hpp"

#include <algorithm>

#include "services/common/bag/bag_folder.hpp"

namespace gvom::bag {
namespace {

constexpr std::uint64_t kMostTold = 20;  // warnings of single messages

std::string list_of(const std::vector<std::unique_ptr<Topic>>& topics) {
  std::string text;
  for (const auto& topic : topics)
    text += (text.empty() ? "" : ", ") + topic->name + " (" + topic->type + ")";
  return text.empty() ? "none" : text;
}

}  // namespace

tl::expected<BagReader, std::string> BagReader::open(const std::string& path,
                                                     const std::vector<std::string>& topics) {
  BagReader bag;
  const auto files = bag_files(path, bag.warnings_);
  if (!files) return tl::unexpected(files.error());
  for (const std::string& file : *files) {
    const auto added = bag.add_part(file);
    if (!added && files->size() == 1) return tl::unexpected(added.error());
    if (!added) {
      ++bag.damaged_;
      bag.warn(added.error() + ": left out");
    }
  }
  if (bag.parts_.empty())
    return tl::unexpected(path + ": none of its files can be read: " + bag.warnings_.back());
  std::stable_sort(bag.parts_.begin(), bag.parts_.end(),
                   [](const Part& a, const Part& b) { return a.first_ns < b.first_ns; });
  const auto by_name = [](const auto& a, const auto& b) { return a->name < b->name; };
  std::stable_sort(bag.topics_.begin(), bag.topics_.end(), by_name);
  const auto wanted = bag.want(path, topics);
  if (!wanted) return tl::unexpected(wanted.error());
  bag.restart();
  return bag;
}

tl::expected<void, std::string> BagReader::add_part(const std::string& path) {
  auto file = open_bag_file(path);
  if (!file) return tl::unexpected(file.error());
  Part part;
  part.path = path;
  part.first_ns = (*file)->first_ns();
  bool has_messages = false;
  for (const FileTopic& topic : (*file)->topics()) {
    part.topics.push_back(topic_of(topic));
    part.topics.back()->messages += topic.messages;
    has_messages = has_messages || topic.messages > 0;
  }
  if (has_messages) {
    first_ns_ = any_message_ ? std::min(first_ns_, part.first_ns) : part.first_ns;
    last_ns_ = any_message_ ? std::max(last_ns_, (*file)->last_ns()) : (*file)->last_ns();
    any_message_ = true;
  }
  part.file = std::move(*file);
  note(part);
  part.file.reset();
  parts_.push_back(std::move(part));
  return {};
}

Topic* BagReader::topic_of(const FileTopic& topic) {
  for (const auto& known : topics_)
    if (known->name == topic.name && known->type == topic.type && known->encoding == topic.encoding)
      return known.get();
  topics_.push_back(std::make_unique<Topic>(Topic{topic.name, topic.type, topic.encoding, 0}));
  return topics_.back().get();
}

tl::expected<void, std::string> BagReader::want(const std::string& path,
                                                const std::vector<std::string>& topics) {
  for (const std::string& name : topics) {
    const auto found = find(name);
    if (found.empty())
      return tl::unexpected(path + ": has no topic '" + name + "'; it has: " + list_of(topics_));
    wanted_.insert(found.begin(), found.end());
  }
  if (topics.empty())
    for (const auto& topic : topics_) wanted_.insert(topic.get());
  for (Part& part : parts_)
    for (std::size_t i = 0; i < part.topics.size(); ++i)
      if (wanted_.count(part.topics[i]) != 0) part.wanted.insert(i);
  return {};
}

std::vector<const Topic*> BagReader::find(const std::string& name) const {
  std::vector<const Topic*> out;
  for (const auto& topic : topics_)
    if (topic->name == name) out.push_back(topic.get());
  return out;
}

void BagReader::rewind() {
  first_round_ = false;
  restart();
}

void BagReader::restart() {
  last_ = nullptr;
  numbers_.clear();
  for (Part& part : parts_) {
    part.begun = part.wanted.empty();
    part.file.reset();
  }
}

bool BagReader::next(Message& out) {
  for (;;) {
    if (last_ != nullptr) advance(*last_);
    last_ = earliest();
    if (last_ == nullptr) return false;
    const Topic* const topic = last_->topics[last_->head.topic];
    out = {topic, ++numbers_[topic], last_->head.log_ns, last_->head.data};
    const auto unpacked = unpacker_.unpack(out.data);
    if (unpacked) return true;
    count_damage();
    if (damaged_ <= kMostTold)
      warn(last_->path + ": " + topic->name + ": message " + std::to_string(out.number) + ": " +
           unpacked.error() + ": left out");
  }
}

/// Files are begun when the messages before them are through.
BagReader::Part* BagReader::earliest() {
  Part* first = nullptr;
  for (Part& part : parts_) {
    if (!part.begun && (first == nullptr || part.first_ns <= first->head.log_ns)) begin(part);
    if (part.file && (first == nullptr || part.head.log_ns < first->head.log_ns)) first = &part;
  }
  return first;
}

void BagReader::begin(Part& part) {
  part.begun = true;
  part.warnings_told = 0;
  auto file = open_bag_file(part.path);
  if (!file) return count_damage(), warn(file.error() + ": left out");
  part.file = std::move(*file);
  if (const auto selected = part.file->select(part.wanted); !selected) {
    part.file.reset();
    return count_damage(), warn(selected.error() + ": left out");
  }
  advance(part);
}

/// Its file is closed at its end, or where nothing more can be read.
void BagReader::advance(Part& part) {
  const auto more = part.file->next(part.head);
  note(part);
  if (more && *more) return;
  if (!more) {
    count_damage();
    warn(more.error() + ": nothing more of it can be read");
  }
  part.file.reset();
}

void BagReader::note(Part& part) {
  const auto& warnings = part.file->warnings();
  while (part.warnings_told < warnings.size()) warn(warnings[part.warnings_told++]);
  damaged_ += std::max(part.file->damaged(), part.damaged_told) - part.damaged_told;
  part.damaged_told = std::max(part.file->damaged(), part.damaged_told);
}

/// Once, however often the bag is read.
void BagReader::warn(const std::string& text) {
  if (told_.insert(text).second) warnings_.push_back(text);
}

}  // namespace gvom::bag
