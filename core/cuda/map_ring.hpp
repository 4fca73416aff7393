// The window's buffer maps on the device: each is sent once and stays until it has left.
//
// A place gets as much memory as the maps need, with something to spare, when the first one comes that needs
// it: the most that a map could need is many times what maps have. So memory is taken in the first ticks, and
// later only where maps outgrow all that came before.
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

  [[nodiscard]] const DeviceMap& map(std::uint32_t place) const { return places_[place].map; }
  /// Bytes of the last map that was sent.
  [[nodiscard]] std::uint64_t bytes_sent() const { return bytes_sent_; }

 private:
  struct Place {
    std::byte* memory = nullptr;
    std::size_t bytes = 0;
    std::uint64_t* observed = nullptr;  // of DeviceMap
    DeviceMap map{};
  };

  /// Where the device reads the map's arrays without a copy.
  [[nodiscard]] DeviceMap read_in_place(const BrickMapView& map);
  /// @return false: the device has failed
  bool make_room(Place& place, std::size_t bytes);
  [[nodiscard]] DeviceMap send_in_one(const BrickMapView& map, std::byte* to);
  [[nodiscard]] DeviceMap send_arrays(const BrickMapView& map, std::byte* to);

  Device& device_;
  bool in_place_;
  std::size_t most_bytes_;      // that a map can have
  std::size_t room_bytes_ = 0;  // that a place gets
  std::vector<Place> places_;
  std::vector<std::uint32_t> free_;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace gvom::cuda
