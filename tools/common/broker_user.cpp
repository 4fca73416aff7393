#include "tools/common/broker_user.hpp"

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include "ipc/broker_probe.hpp"

namespace gvom::tools {

bool become_broker_user() {
  const auto owner = ipc::broker_owner();
  if (::geteuid() != 0 || !owner || owner->user == 0) return true;
  const passwd* const user = ::getpwuid(owner->user);
  const bool groups_set =
      user != nullptr ? ::initgroups(user->pw_name, owner->group) == 0 : ::setgroups(0, nullptr) == 0;
  return groups_set && ::setresgid(owner->group, owner->group, owner->group) == 0 &&
         ::setresuid(owner->user, owner->user, owner->user) == 0;
}

}  // namespace gvom::tools
