#include "ipc/broker.hpp"

#include <sys/stat.h>
#include <sys/statvfs.h>

#include <string>
#include <thread>
#include <utility>

#include "iceoryx_posh/internal/roudi/roudi.hpp"
#include "iceoryx_posh/mepoo/chunk_header.hpp"
#include "iceoryx_posh/roudi/iceoryx_roudi_components.hpp"
#include "ipc/doorbell.hpp"
#include "ipc/error_guard.hpp"
#include "ipc/system.hpp"

namespace gvom::ipc {
namespace {

constexpr char kSharedMemory[] = "/dev/shm";
constexpr std::uint64_t kBookkeepingBytes = 72u << 20;  // ports and queues: 66 MB measured
constexpr std::uint64_t kBytesPerChunk = 64;            // bookkeeping of each
constexpr std::chrono::milliseconds kStartTimeout{5000};

/// The hook is a base, so that it is there before RouDi's constructor starts the threads that call it.
struct Hook {
  std::function<void()> heartbeat;
};

class HookedRouDi : private Hook, public iox::roudi::RouDi {
 public:
  HookedRouDi(iox::roudi::IceOryxRouDiComponents& components, std::function<void()> call)
      : Hook{std::move(call)},
        RouDi(components.rouDiMemoryManager, components.portManager,
              RoudiStartupParameters(iox::roudi::MonitoringMode::OFF, false)) {}

  void cyclicUpdateHook() noexcept override {
    if (heartbeat) heartbeat();
  }
};

/// Takes the bell that start() made away again.
struct DoorbellOwner {
  DoorbellOwner() = default;
  ~DoorbellOwner() { Doorbell::remove(); }
  DoorbellOwner(const DoorbellOwner&) = delete;
  DoorbellOwner& operator=(const DoorbellOwner&) = delete;
};

iox::RouDiConfig_t roudi_config(const PoolPlan& plan, const std::string& group) {
  iox::mepoo::MePooConfig pools;
  for (const Pool& pool : plan.pools) pools.addMemPool({pool.chunk_bytes, pool.chunks});
  const iox::posix::PosixGroup::string_t name(iox::cxx::TruncateToCapacity, group);
  iox::RouDiConfig_t config;
  config.m_sharedMemorySegments.push_back({name, name, pools});
  return config;
}

Expected<void> check_place_is_free() {
  if (broker_answers()) {
    return tl::unexpected(
        Error{ErrorKind::in_use, std::string("another broker answers at ") + kBrokerSocket});
  }
  for (const char* name : {iox::roudi::IPC_CHANNEL_ROUDI_NAME, iox::roudi::ROUDI_LOCK_NAME}) {
    if (auto is_free = check_name_is_free(name); !is_free) return is_free;
  }
  return {};
}

/// What a dead broker left: the new one takes its place.
std::uint64_t stale_bytes(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_blocks) * 512 : 0;
}

bool wait_until_it_answers() {
  const auto deadline = std::chrono::steady_clock::now() + kStartTimeout;
  while (!broker_answers()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace

struct Broker::State {
  State(const BrokerOptions& options, const std::string& group)
      : components(roudi_config(options.plan, group)), roudi(components, options.heartbeat) {}

  iox::roudi::IceOryxRouDiComponents components;
  DoorbellOwner doorbell;  // goes after the broker's socket: whoever may still join finds it
  HookedRouDi roudi;
};

std::uint64_t shared_memory_bytes(const PoolPlan& plan) {
  std::uint64_t bytes = plan.total_bytes + kBookkeepingBytes;
  for (const Pool& pool : plan.pools)
    bytes += pool.chunks * (sizeof(iox::mepoo::ChunkHeader) + kBytesPerChunk);
  return bytes;
}

Expected<void> check_space(const PoolPlan& plan) {
  const auto group = group_name();
  if (!group) return tl::unexpected(group.error());
  struct statvfs space {};
  if (::statvfs(kSharedMemory, &space) != 0) {
    return tl::unexpected(Error{ErrorKind::no_space, std::string(kSharedMemory) + " is not there"});
  }
  const std::uint64_t available = std::uint64_t{space.f_bavail} * space.f_frsize +
                                  stale_bytes(kManagementFile) + stale_bytes(kSharedMemory + ("/" + *group));
  const std::uint64_t needed = shared_memory_bytes(plan);
  if (needed <= available) return {};
  return tl::unexpected(Error{ErrorKind::no_space, "the pools need " + std::to_string(needed) + " bytes in " +
                                                       kSharedMemory + ", " + std::to_string(available) +
                                                       " are available: enlarge it, or lower map.size_xy, "
                                                       "window.buffer_size, lidars.*.max_returns or "
                                                       "ipc.max_planners"});
}

Expected<Broker> Broker::start(BrokerOptions options) {
  const auto group = group_name();
  if (!group) return tl::unexpected(group.error());
  if (auto is_free = check_place_is_free(); !is_free) return tl::unexpected(is_free.error());
  if (auto fits = check_space(options.plan); !fits) return tl::unexpected(fits.error());
  if (auto bell = Doorbell::install(); !bell) return tl::unexpected(bell.error());
  install_error_guard(options.log);
  Broker broker(std::make_unique<State>(options, *group));
  if (wait_until_it_answers()) return broker;
  return tl::unexpected(Error{ErrorKind::unavailable, "the broker does not answer at its own socket"});
}

Broker::Broker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Broker::Broker(Broker&&) noexcept = default;
Broker& Broker::operator=(Broker&&) noexcept = default;
Broker::~Broker() = default;

}  // namespace gvom::ipc
