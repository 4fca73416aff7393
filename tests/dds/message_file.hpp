// Messages for a peer to send.
#pragma once

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "services/common/dds/names.hpp"
#include "tests/dds/peer_process.hpp"
#include "tests/support/ros_messages.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::dds::test {

/// A file of serialised messages of one type of ROS's, and who sends them, one each go().
class MessageFile {
 public:
  /// `type`: "sensor_msgs/msg/PointCloud2".
  explicit MessageFile(std::string type) : type_(std::move(type)) {}

  MessageFile& add(const gvom::test::Octets& message) {
    const auto size = static_cast<std::uint32_t>(message.size());
    file_.write(reinterpret_cast<const char*>(&size), sizeof size);
    file_.write(reinterpret_cast<const char*>(message.data()), size);
    file_.flush();
    return *this;
  }
  /// For a Peer.
  [[nodiscard]] std::vector<std::string> sender(int domain, const std::string& topic) const {
    return {std::to_string(domain), "send-file", topic, path(), type_on_wire(type_).value()};
  }
  [[nodiscard]] const std::string& type() const { return type_; }

 private:
  [[nodiscard]] std::string path() const { return folder_.path() + "/messages"; }

  std::string type_;
  gvom::test::TemporaryFolder folder_;
  std::ofstream file_{path(), std::ios::binary};
};

}  // namespace gvom::dds::test
