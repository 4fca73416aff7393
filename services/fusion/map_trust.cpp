#include "services/fusion/map_trust.hpp"

#include <algorithm>
#include <cstdio>

namespace gvom::fusion {

namespace {

/// The odometry that an ingest maps by may reach fusion a little later, at 1 Hz by a second.
constexpr std::int64_t kMostAhead_ns = 1'000'000'000;

MapLie lie(MapLie::About about, const std::string& why) {
  return {about, "map refused: " + why};
}

std::string seconds(std::int64_t time_ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", static_cast<double>(time_ns) * 1e-9);
  return text;
}

std::string epoch_of(const ipc::BrickMap& map) {
  return "its epoch " + std::to_string(map.header.epoch);
}

}  // namespace

void MapTrust::take(const ipc::MessageHeader& odometry) {
  if (heard_ && odometry.epoch < odometry_epoch_) return;  // of a clock that has been replaced
  const bool anew = !heard_ || odometry.epoch > odometry_epoch_;
  const bool goes_on = anew || odometry.stamp_ns >= odometry_stamp_ns_;
  odometry_epoch_ = odometry.epoch;
  heard_ = true;
  if (!goes_on && !has_gone_back(odometry.sequence)) return;
  odometry_stamp_ns_ = odometry.stamp_ns;
  back_since_.reset();
}

bool MapTrust::has_gone_back(std::uint64_t sequence) {
  if (!back_since_ || sequence < *back_since_) back_since_ = sequence;
  return sequence - *back_since_ + 1 >= kAnew;
}

std::optional<MapLie> MapTrust::judge(const ipc::BrickMap& map, std::int64_t now_ns) const {
  const ipc::MessageHeader& header = map.header;
  if (heard_ && header.epoch > odometry_epoch_)
    return lie(MapLie::About::epoch, epoch_of(map) + " was announced by no odometry");
  if (!heard_ && believed_ && header.epoch > map_epoch_)
    return lie(MapLie::About::epoch, epoch_of(map) + " is that of no other map, and no odometry is heard");
  if (map.mono_received_ns <= 0 || map.mono_received_ns > now_ns)
    return lie(MapLie::About::time, "its packets came at no time, or are to come");
  if (map.odometry_jump_ns > header.stamp_ns)
    return lie(MapLie::About::time, "the odometry is to jump " +
                                        seconds(map.odometry_jump_ns - header.stamp_ns) + " after its stamp");
  const bool comparable = heard_ && header.epoch == odometry_epoch_;
  if (comparable && map.odometry_jump_ns > odometry_stamp_ns_)
    return lie(MapLie::About::time, "the odometry is to jump " +
                                        seconds(map.odometry_jump_ns - odometry_stamp_ns_) +
                                        " after what is heard of it");
  if (comparable && header.stamp_ns - kMostAhead_ns > odometry_stamp_ns_)
    return lie(MapLie::About::time,
               "its stamp is " + seconds(header.stamp_ns - odometry_stamp_ns_) + " ahead of the odometry");
  return std::nullopt;
}

void MapTrust::believe(const ipc::BrickMap& map) {
  const bool anew = !believed_ || map.header.epoch != map_epoch_;
  map_stamp_ns_ = anew ? map.header.stamp_ns : std::max(map_stamp_ns_, map.header.stamp_ns);
  map_epoch_ = map.header.epoch;
  believed_ = true;
}

bool MapTrust::was_deceived() const {
  if (!heard_ || !believed_) return false;
  const bool same = map_epoch_ == odometry_epoch_;
  return map_epoch_ > odometry_epoch_ || (same && map_stamp_ns_ - kMostAhead_ns > odometry_stamp_ns_);
}

void MapTrust::forget() {
  believed_ = false;
}

}  // namespace gvom::fusion
