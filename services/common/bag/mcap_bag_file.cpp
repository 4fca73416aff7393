// MCAP files as parts of a bag.
#include <map>
#include <utility>

#include "services/common/bag/bag_file.hpp"
#include "services/common/mcap/mcap_reader.hpp"

namespace gvom::bag {
namespace {

class McapBagFile final : public BagFile {
 public:
  explicit McapBagFile(mcap::McapReader reader) : reader_(std::move(reader)) {
    for (const auto& [id, channel] : reader_.channels()) {
      topic_of_channel_[id] = topics_.size();
      topics_.push_back({channel.topic, channel.type, channel.encoding, channel.messages});
    }
  }

  [[nodiscard]] const std::vector<FileTopic>& topics() const override { return topics_; }
  [[nodiscard]] std::int64_t first_ns() const override { return reader_.first_ns(); }
  [[nodiscard]] std::int64_t last_ns() const override { return reader_.last_ns(); }

  tl::expected<void, std::string> select(const std::set<std::size_t>& topics) override {
    std::set<std::uint16_t> channels;
    for (const auto& [id, topic] : topic_of_channel_)
      if (topics.count(topic) != 0) channels.insert(id);
    reader_.select(channels);
    return {};
  }

  tl::expected<bool, std::string> next(FileMessage& out) override {
    mcap::Message message;
    const auto more = reader_.next(message);
    if (more && *more) out = {topic_of_channel_.at(message.channel->id), message.log_ns, message.data};
    return more;
  }

  [[nodiscard]] std::uint64_t damaged() const override { return reader_.damaged(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return reader_.warnings(); }

 private:
  mcap::McapReader reader_;
  std::vector<FileTopic> topics_;
  std::map<std::uint16_t, std::size_t> topic_of_channel_;
};

}  // namespace

FileResult open_mcap(const std::string& path, const std::string& name) {
  auto reader = mcap::McapReader::open(path, name);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<McapBagFile>(std::move(*reader));
}

}  // namespace gvom::bag
