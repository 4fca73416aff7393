// What a buffer map cannot be, by the odometry that fusion hears itself. One faulty publisher must not take
// the map from the other lidars: an epoch, a stamp or a jump ahead of everybody's makes all others too old.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/messages.hpp"
#include "services/common/pose_judge.hpp"

namespace gvom::fusion {

/// Why nothing of a map is believed.
struct MapLie {
  enum class About { epoch, time };
  About about;
  std::string why;  ///< In words.
};

class MapTrust {
 public:
  /// Every message of the odometry, or the newest of them. A stamp that goes back is a stray until `kAnew`
  /// messages running have done so, as for an ingest: then the clock went back, and what lies ahead is wrong.
  void take(const ipc::MessageHeader& odometry);

  /// Nothing if the map can be what it says at `now_ns` of CLOCK_MONOTONIC. Hear the odometry first: an
  /// ingest maps by what it has heard. Until odometry is heard, the first map's epoch counts.
  [[nodiscard]] std::optional<MapLie> judge(const ipc::BrickMap& map, std::int64_t now_ns) const;

  /// The map was fused.
  void believe(const ipc::BrickMap& map);

  /// Whether maps were believed that the odometry now contradicts, since it was heard only later or its clock
  /// went back: forget them all.
  [[nodiscard]] bool was_deceived() const;
  void forget();

 private:
  static constexpr std::uint64_t kAnew = services::PoseJudge::kAnew;

  /// Whether all messages that were heard since so many have gone back.
  bool has_gone_back(std::uint64_t sequence);

  bool heard_ = false;  // odometry
  std::uint64_t odometry_epoch_ = 0;
  std::int64_t odometry_stamp_ns_ = 0;
  std::optional<std::uint64_t> back_since_;  // the first message that went back; nothing: the newest did not
  bool believed_ = false;                    // some map
  std::uint64_t map_epoch_ = 0;
  std::int64_t map_stamp_ns_ = 0;  // the newest of that epoch
};

}  // namespace gvom::fusion
