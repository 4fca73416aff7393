// The process on the bus: a planner that reads all layers, and hears what the others say of themselves.
#pragma once

#include "tools/endurance/board.hpp"

namespace gvom::endurance {

/// Joins as "gvom-soak" and sends notes to `socket` until nobody reads them or the broker is gone; tells the
/// board each new epoch. The code to exit with, by _exit(): destructors can hang.
int listen_on_bus(Board& board, int socket);

}  // namespace gvom::endurance
