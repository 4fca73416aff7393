#include "services/common/dds/graph.hpp"

#include <string>
#include <utility>

namespace gvom::dds {
namespace {

/// Just what the graph's message is made of.
class Cdr {
 public:
  void word(std::uint32_t value) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);  // the head has four bytes, so both counts agree
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
  }

  void text(const std::string& value) {
    word(static_cast<std::uint32_t>(value.size()) + 1);
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.push_back(0);
  }

  void gid(const Guid& guid, std::size_t size) {
    bytes_.insert(bytes_.end(), guid.begin(), guid.end());
    bytes_.resize(bytes_.size() + size - guid.size());
  }

  void gids(const std::vector<Guid>& guids, std::size_t size) {
    word(static_cast<std::uint32_t>(guids.size()));
    for (const Guid& guid : guids) gid(guid, size);
  }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_ = {0, 1, 0, 0};
};

}  // namespace

ros::Blob graph_message(const NodeEntities& entities, Distro distro) {
  const std::size_t gid_size = distro == Distro::humble ? 24 : 16;
  Cdr cdr;
  cdr.gid(entities.participant, gid_size);
  cdr.word(1);  // nodes
  cdr.text(entities.node.space);
  cdr.text(entities.node.name);
  cdr.gids(entities.readers, gid_size);
  cdr.gids(entities.writers, gid_size);
  return std::make_shared<const std::vector<std::uint8_t>>(cdr.take());
}

}  // namespace gvom::dds
