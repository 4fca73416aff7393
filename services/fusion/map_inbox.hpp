// The buffer maps of all lidars as they come, and those that the window still needs, where they lie.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/window.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/messages.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::fusion {

/// A map that came, held in shared memory until it is released.
struct ArrivedMap {
  int lidar;
  std::uint64_t token;
  const ipc::BrickMapSample* sample;
};

class MapInbox {
 public:
  /// A subscriber for each lidar, added to `waiter`.
  static ipc::Expected<MapInbox> open(ipc::Runtime& runtime, ipc::Waiter& waiter,
                                      const services::VehicleConfig& config);

  /// The next unread map; lidars take turns. Nothing if none is there. The map must be released, or kept
  /// until its token leaves the window.
  std::optional<ArrivedMap> take();
  void release(std::uint64_t token);
  /// The map was fused: it is the newest of its lidar, for Layers.
  void note_fused(const ArrivedMap& map);
  /// The window begins anew: as if none had been fused.
  void forget_fused();
  /// Of a map that is held.
  [[nodiscard]] const ipc::BrickMap& header(std::uint64_t token) const { return held_[token]->header(); }

  /// How far each lidar's maps were taken and fused, for Progress and Layers.
  struct Lidar {
    std::string name;
    ipc::BrickMapSubscriber maps;
    std::uint64_t taken_sequence = 0;
    std::int64_t newest_stamp_ns = 0;
    float columns_seen_fraction = 0;  // of the newest sweep
    ipc::Ground ground{};             // as the newest map says
    std::uint64_t told_refusals = 0;
  };
  [[nodiscard]] const std::vector<Lidar>& lidars() const { return lidars_; }
  /// Why the newest of the messages that were refused since the last call was.
  std::optional<std::string> new_refusal();
  /// How many messages of all lidars were refused, and lost in gaps.
  [[nodiscard]] std::uint64_t refused() const;
  [[nodiscard]] std::uint64_t lost() const;

 private:
  explicit MapInbox(std::size_t slots) : held_(slots) {}
  [[nodiscard]] std::size_t free_slot() const;

  std::vector<Lidar> lidars_;
  std::vector<std::optional<ipc::BrickMapSample>> held_;  // index: token
  std::size_t turn_ = 0;
};

}  // namespace gvom::fusion
