// Messages for the peer, written out by hand.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "services/common/ros/blob.hpp"

namespace gvom::dds::test {

using Bytes = std::vector<std::uint8_t>;

class CdrBytes {
 public:
  template <typename T>
  CdrBytes& put(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    bytes_.resize(bytes_.size() + sizeof(T));
    std::memcpy(bytes_.data() + bytes_.size() - sizeof(T), &value, sizeof(T));
    return *this;
  }
  CdrBytes& put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    return *this;
  }
  CdrBytes& put(const Bytes& octets) {
    put(static_cast<std::uint32_t>(octets.size()));
    bytes_.insert(bytes_.end(), octets.begin(), octets.end());
    return *this;
  }
  ros::Blob blob() { return std::make_shared<const Bytes>(std::move(bytes_)); }

 private:
  Bytes bytes_ = {0, 1, 0, 0};
};

/// What the peer says of the bytes of a grid or cloud.
inline std::uint64_t sum_of(const Bytes& data) {
  std::uint64_t sum = 0;
  for (const std::uint8_t byte : data) sum = sum * 31 + byte;
  return sum;
}

/// nav_msgs/msg/OccupancyGrid at 7.5 s in "odom", of 0.25 m.
inline ros::Blob grid_message(std::uint32_t width, std::uint32_t height, const Bytes& cost) {
  CdrBytes cdr;
  cdr.put(std::int32_t{7}).put(std::uint32_t{500'000'000}).put(std::string("odom"));
  cdr.put(std::int32_t{0}).put(std::uint32_t{0}).put(0.25F).put(width).put(height);
  for (int i = 0; i < 7; ++i) cdr.put(0.0);
  return cdr.put(cost).blob();
}

/// sensor_msgs/msg/PointCloud2 at `second` s, without fields.
inline ros::Blob cloud_message(std::int32_t second, const Bytes& data) {
  CdrBytes cdr;
  const auto points = static_cast<std::uint32_t>(data.size() / 32);
  cdr.put(second).put(std::uint32_t{0}).put(std::string("odom")).put(std::uint32_t{1}).put(points);
  cdr.put(std::uint32_t{0}).put(std::uint8_t{0}).put(std::uint32_t{32}).put(points * 32);
  return cdr.put(data).put(std::uint8_t{1}).blob();
}

}  // namespace gvom::dds::test
