// The sensors and the odometry of the lab: what their processes do.
#pragma once

#include <cstdint>

#include "tests/faults/lab.hpp"

namespace gvom::test {

inline constexpr std::int64_t kDriveBegin_ns = 1'000'000'000'000;  // of the sensors' clock

/// Sends to the port as `mode` says, until it is killed. Its clock is so far ahead of the odometry's.
[[noreturn]] void live_as_sensor(std::uint16_t port, const std::atomic<SensorMode>& mode,
                                 const std::atomic<std::int64_t>& ahead_ns, const Board& board);

/// Publishes the pose of the vehicle, which stands still, as the board says.
[[noreturn]] void live_as_odometry(Board& board);

/// Looks at every fused map.
[[noreturn]] void live_as_judge(Board& board);

}  // namespace gvom::test
