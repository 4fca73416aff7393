// The window's buffer maps on the device: each is sent once and stays until it has left.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/device_map.hpp"

namespace gvom::cuda {

class MapRing {
 public:
  /// @param places maps held at a time
  /// @param most_records of any map
  /// @param in_place maps lie in pinned memory that the device shares with the host: nothing is copied
  MapRing(Device& device, const MapConfig& map, std::size_t places, std::size_t most_records, bool in_place);

  /// A free place, to be given back. Fails the device if there is none.
  std::uint32_t take();
  void give_back(std::uint32_t place) { free_.push_back(place); }

  /// Sends a map to its place. Its memory is read until the device has waited.
  void send(const BrickMapView& map, std::uint32_t place);

  [[nodiscard]] const DeviceMap& map(std::uint32_t place) const { return maps_[place]; }
  /// Bytes of the last map that was sent.
  [[nodiscard]] std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  [[nodiscard]] DeviceMap send_in_one(const BrickMapView& map, std::byte* to);
  [[nodiscard]] DeviceMap send_arrays(const BrickMapView& map, std::byte* to);

  Device& device_;
  bool in_place_;
  std::size_t most_bytes_;
  std::vector<std::byte*> memory_;  // of each place
  std::vector<DeviceMap> maps_;
  std::vector<std::uint32_t> free_;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace gvom::cuda
