#include "core/cuda/map_ring.hpp"

#include <algorithm>

namespace gvom::cuda {

namespace {

constexpr std::size_t kRoomStep = std::size_t{1} << 20;

std::size_t most_bytes_of(const MapConfig& map, std::size_t most_records) {
  const Grid grid = grid_around(map, Eigen::Vector3d::Zero());
  const std::uint32_t slots = grid.brick_slots();
  const std::size_t records = std::min(most_records, std::size_t{slots} * kBrickCells);
  return brick_map_layout(0, {slots, slots, static_cast<std::uint32_t>(records), grid.columns()}).bytes;
}

}  // namespace

MapRing::MapRing(Device& device, const MapConfig& map, std::size_t places, std::size_t most_records,
                 bool in_place)
    : device_(device), in_place_(in_place), most_bytes_(most_bytes_of(map, most_records)), places_(places) {
  const Int3 bricks = grid_around(map, Eigen::Vector3d::Zero()).bricks();
  const std::size_t stacks = static_cast<std::size_t>(bricks[0]) * static_cast<std::size_t>(bricks[1]);
  auto* const observed = device.array<std::uint64_t>(places * stacks);
  for (std::size_t place = places; place-- > 0;) {
    free_.push_back(static_cast<std::uint32_t>(place));
    places_[place].observed = observed + place * stacks;
  }
}

std::uint32_t MapRing::take() {
  if (free_.empty()) return device_.fail("more maps are in the window than there is room for"), 0;
  const std::uint32_t place = free_.back();
  free_.pop_back();
  return place;
}

void MapRing::send(const BrickMapView& map, std::uint32_t place) {
  bytes_sent_ = 0;
  Place& to = places_[place];
  if (in_place_) {
    to.map = read_in_place(map);
  } else {
    const bool in_one = map.bytes_in_one > 0;
    if (!make_room(to, in_one ? map.bytes_in_one : brick_map_layout(0, map.shape).bytes)) return;
    to.map = in_one ? send_in_one(map, to.memory) : send_arrays(map, to.memory);
  }
  to.map.observed = to.observed;
}

DeviceMap MapRing::read_in_place(const BrickMapView& map) {
  const auto seen = [this](const auto* host, std::uint32_t count) {
    return static_cast<decltype(host)>(count > 0 ? device_.in_place(host) : nullptr);
  };
  const BrickMapShape& shape = map.shape;
  const DeviceMap at{map.grid,
                     map.stamp_ns,
                     seen(map.directory, shape.brick_slots),
                     seen(map.lookup, shape.brick_count),
                     seen(map.columns, shape.brick_count),
                     seen(map.lowest_ray_m, shape.column_count),
                     seen(map.records, shape.record_count),
                     nullptr};
  if (at.directory == nullptr) device_.fail("a map lies outside of the pinned memory");
  return at;
}

bool MapRing::make_room(Place& place, std::size_t bytes) {
  if (bytes > most_bytes_) return device_.fail("a map is larger than there is room for on the device"), false;
  if (bytes <= place.bytes) return true;
  const std::size_t with_spare = (bytes + bytes / 4 + kRoomStep - 1) / kRoomStep * kRoomStep;
  room_bytes_ = std::max(room_bytes_, std::min(with_spare, most_bytes_));
  if (place.memory != nullptr) static_cast<void>(device_.wait());  // the last tick may still read it
  device_.release(place.memory);
  place.memory = device_.array<std::byte>(room_bytes_);
  place.bytes = place.memory != nullptr ? room_bytes_ : 0;
  return place.memory != nullptr;
}

DeviceMap MapRing::send_in_one(const BrickMapView& map, std::byte* to) {
  device_.upload(to, map.directory, map.bytes_in_one);
  bytes_sent_ = map.bytes_in_one;
  const auto* from = reinterpret_cast<const std::byte*>(map.directory);
  const auto moved = [&](const auto* host) {
    return reinterpret_cast<decltype(host)>(to + (reinterpret_cast<const std::byte*>(host) - from));
  };
  return {map.grid,
          map.stamp_ns,
          moved(map.directory),
          moved(map.lookup),
          moved(map.columns),
          moved(map.lowest_ray_m),
          moved(map.records),
          nullptr};
}

DeviceMap MapRing::send_arrays(const BrickMapView& map, std::byte* to) {
  const BrickMapLayout layout = brick_map_layout(0, map.shape);
  const auto send = [this](std::byte* place, const auto* host, std::size_t count) {
    device_.upload(place, host, count * sizeof *host);
    bytes_sent_ += count * sizeof *host;
    return reinterpret_cast<decltype(host)>(place);
  };
  return {map.grid,
          map.stamp_ns,
          send(to, map.directory, map.shape.brick_slots),
          send(to + layout.lookup, map.lookup, std::size_t{map.shape.brick_count} * kBrickCells),
          send(to + layout.columns, map.columns, map.shape.brick_count),
          send(to + layout.lowest_ray, map.lowest_ray_m, map.shape.column_count),
          send(to + layout.records, map.records, map.shape.record_count),
          nullptr};
}

}  // namespace gvom::cuda
