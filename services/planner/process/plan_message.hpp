// A plan as it travels.
#pragma once

#include "ipc/messages.hpp"
#include "services/planner/planner.hpp"

namespace gvom::planner {

/// All but the header, the goal and the times. Paths longer than a message are cut.
void fill(const Plan& plan, ipc::Plan& message);

/// A plan to stand still, and why: where there is nothing to plan with.
Plan standing(Reason reason, std::string why);

}  // namespace gvom::planner
