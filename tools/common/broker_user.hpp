// Who may join the bus.
#pragma once

namespace gvom::tools {

/// As root: becomes the user and group that the broker runs as, for only they are let in. Call it with the
/// configuration read, and before anything is written. False, and errno, if that is refused.
bool become_broker_user();

}  // namespace gvom::tools
