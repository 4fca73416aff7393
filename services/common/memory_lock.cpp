#include "services/common/memory_lock.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

namespace gvom::services {

tl::expected<void, std::string> lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool unlimited = limit.rlim_cur == RLIM_INFINITY;
  const int flags = MCL_CURRENT | MCL_ONFAULT | (unlimited ? MCL_FUTURE : 0);
  if (mlockall(flags) == 0) return {};
  const int reason = errno;
  const std::string bytes = unlimited ? "unlimited" : std::to_string(limit.rlim_cur) + " bytes";
  return tl::make_unexpected(std::string("memory is not locked and may be swapped out: ") +
                             std::strerror(reason) + " (the limit on locked memory is " + bytes +
                             "; with systemd, LimitMEMLOCK=infinity)");
}

}  // namespace gvom::services
