// The traces that the bus leaves in the file system. Internal to ipc/.
#pragma once

#include <cstdint>
#include <string>

#include "ipc/error.hpp"

namespace gvom::ipc {

inline constexpr char kBrokerSocket[] = "/tmp/roudi";
inline constexpr char kManagementFile[] = "/dev/shm/iceoryx_mgmt";

/// The name of this process's effective group, which names the payload's segment; denied if it has none.
Expected<std::string> group_name();

/// Nothing if no living process holds `/tmp/NAME.lock` and no file of another user is in its way.
/// Errors: in_use, denied.
Expected<void> check_name_is_free(const std::string& name);

/// The inode of the broker's bookkeeping, another one for each broker; 0: none is there.
std::uint64_t management_inode();

}  // namespace gvom::ipc
