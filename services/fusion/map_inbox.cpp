#include "services/fusion/map_inbox.hpp"

#include <algorithm>

namespace gvom::fusion {

ipc::Expected<MapInbox> MapInbox::open(ipc::Runtime& runtime, ipc::Waiter& waiter,
                                       const services::VehicleConfig& config) {
  // A full window, and the map in hand.
  MapInbox inbox(config.lidars.size() * static_cast<std::size_t>(config.mapper.window.buffer_size) + 1);
  for (const services::LidarConfig& lidar : config.lidars) {
    auto maps = ipc::BrickMapSubscriber::buffer_map(runtime, lidar.name);
    if (!maps) return tl::unexpected(maps.error());
    waiter.add(*maps);
    inbox.lidars_.push_back({lidar.name, std::move(*maps)});
  }
  return inbox;
}

std::size_t MapInbox::free_slot() const {
  const auto free = std::find_if(held_.begin(), held_.end(), [](const auto& sample) { return !sample; });
  return static_cast<std::size_t>(free - held_.begin());
}

std::optional<ArrivedMap> MapInbox::take() {
  for (std::size_t tries = 0; tries < lidars_.size(); ++tries) {
    const std::size_t index = turn_;
    turn_ = (turn_ + 1) % lidars_.size();
    Lidar& lidar = lidars_[index];
    auto sample = lidar.maps.take();
    if (!sample) continue;
    const std::size_t token = free_slot();
    held_[token] = std::move(*sample);
    lidar.taken_sequence = held_[token]->header().header.sequence;
    return ArrivedMap{static_cast<int>(index), token, &*held_[token]};
  }
  return std::nullopt;
}

void MapInbox::note_fused(const ArrivedMap& map) {
  Lidar& lidar = lidars_[static_cast<std::size_t>(map.lidar)];
  lidar.newest_stamp_ns = map.sample->header().header.stamp_ns;
  lidar.columns_seen_fraction = map.sample->header().columns_seen_fraction;
  lidar.ground = map.sample->header().ground;
}

void MapInbox::forget_fused() {
  for (Lidar& lidar : lidars_) {
    lidar.newest_stamp_ns = 0;
    lidar.columns_seen_fraction = 0;
    lidar.ground = {};
  }
}

void MapInbox::release(std::uint64_t token) {
  held_[token].reset();
}

std::uint64_t MapInbox::refused() const {
  std::uint64_t sum = 0;
  for (const Lidar& lidar : lidars_) sum += lidar.maps.counters().refused();
  return sum;
}

std::uint64_t MapInbox::lost() const {
  std::uint64_t sum = 0;
  for (const Lidar& lidar : lidars_) sum += lidar.maps.counters().lost;
  return sum;
}

std::optional<std::string> MapInbox::new_refusal() {
  std::optional<std::string> why;
  for (Lidar& lidar : lidars_) {
    const std::uint64_t refused = lidar.maps.counters().refused();
    if (refused > lidar.told_refusals) why = lidar.maps.newest_refusal();
    lidar.told_refusals = refused;
  }
  return why;
}

}  // namespace gvom::fusion
