// How old layers are: the one answer for planners, fusion's Health, gvomctl and gvom-snapshot.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "ipc/messages.hpp"

namespace gvom::ipc {

/// The oldest layers that a planner is given if it asks for nothing else. A 10 Hz lidar's newest packets are
/// 0.15 s old at most when all is well, and 0.35 s after two lost sweeps. At 12 m/s a vehicle drives 6 m
/// blind in half a second.
inline constexpr std::chrono::milliseconds kDefaultMaxAge{500};

/// An age that cannot be told: older than any other.
inline constexpr auto kUnknownAge = std::chrono::nanoseconds::max();

/// A time of this machine. CLOCK_MONOTONIC stands still while the machine is suspended.
struct Moment {
  std::int64_t mono_ns = 0;       ///< CLOCK_MONOTONIC; 0: never.
  std::int64_t suspended_ns = 0;  ///< How long the machine had been suspended until then.

  static Moment now();
};

/// When the newest packet in the layers was received.
Moment received_at(const Layers& layers);
/// When the newest packet in the map, of a sweep or of the fused voxels, was received.
Moment received_at(const BrickMap& map);

/// From `then` to `now`, suspensions between them included. kUnknownAge where `then` was never, or is later
/// than `now`: it is of another clock, or somebody lies.
std::chrono::nanoseconds elapsed(const Moment& then, const Moment& now);

/// "2.1 s old"; "of unknown age: ..." for kUnknownAge.
std::string age_words(std::chrono::nanoseconds age);

}  // namespace gvom::ipc
