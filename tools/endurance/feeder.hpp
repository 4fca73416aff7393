// The process that is all lidars: sends their packets in each round of the odometry.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/endurance/board.hpp"
#include "tools/endurance/recording.hpp"

namespace gvom::endurance {

/// Until the process is killed, or nobody reads its notes any more; the code to exit with. It is not on the
/// bus.
int feed_packets(Recording recording, const std::vector<std::uint16_t>& ports, const Board& board,
                 int socket);

}  // namespace gvom::endurance
