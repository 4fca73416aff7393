// A plan as it travels.
#pragma once

#include "ipc/messages.hpp"
#include "services/planner/planner.hpp"

namespace gvom::planner {

/// All but the header, the goal and the times. Paths longer than a message are cut.
void fill(const Plan& plan, ipc::Plan& message);

}  // namespace gvom::planner
