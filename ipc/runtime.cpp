#include "ipc/runtime.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "iceoryx_posh/runtime/posh_runtime.hpp"
#include "ipc/doorbell.hpp"
#include "ipc/error_guard.hpp"
#include "ipc/system.hpp"

namespace gvom::ipc {
namespace {

constexpr std::chrono::milliseconds kProbePeriod{20};

std::atomic<bool> joined{false};

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         c == '-';
}

bool wait_for_broker(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!broker_answers()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kProbePeriod);
  }
  return true;
}

/// The file of the payload's segment, which exists if the broker made it for our group.
Expected<std::string> segment_path() {
  return group_name().and_then([](const std::string& group) -> Expected<std::string> {
    std::string path = "/dev/shm/" + group;
    if (::access(path.c_str(), R_OK | W_OK) == 0) return path;
    return tl::unexpected(Error{ErrorKind::denied, "group '" + group +
                                                       "' of this process has no memory on the bus (" + path +
                                                       "): run it in the broker's group"});
  });
}

Expected<void> check_may_join(const std::string& name, std::chrono::milliseconds timeout) {
  if (auto good = check_runtime_name(name); !good) return good;
  if (joined) return tl::unexpected(Error{ErrorKind::in_use, "this process is on the bus already"});
  if (!wait_for_broker(timeout)) {
    return tl::unexpected(Error{ErrorKind::unavailable, "no broker answers at " + std::string(kBrokerSocket) +
                                                            " within " + std::to_string(timeout.count()) +
                                                            " ms: is gvom-roudi running?"});
  }
  return check_name_is_free(name);
}

}  // namespace

struct Runtime::State {
  std::string name;
  std::string segment;
  std::uint64_t broker_inode;
  std::shared_ptr<Doorbell> doorbell;
};

Expected<void> check_runtime_name(const std::string& name) {
  const bool good = !name.empty() && name.size() <= kMaxRuntimeName && name.front() != '.' &&
                    name != "roudi" && std::all_of(name.begin(), name.end(), is_name_character);
  if (good) return {};
  return tl::unexpected(
      Error{ErrorKind::bad_name, "process name '" + name +
                                     "': expected 1 to 63 of [A-Za-z0-9_.-], not starting with "
                                     "a dot, not 'roudi'"});
}

Expected<Runtime> Runtime::connect(const std::string& name, std::chrono::milliseconds timeout, LogSink log,
                                   StopAsked stop_asked) {
  if (auto may_join = check_may_join(name, timeout); !may_join) return tl::unexpected(may_join.error());
  auto segment = segment_path();
  if (!segment) return tl::unexpected(segment.error());
  const std::uint64_t broker_inode = management_inode();  // before the bell: that is no older then
  auto doorbell = Doorbell::open();
  if (!doorbell) return tl::unexpected(doorbell.error());
  auto state = std::make_unique<State>(State{name, std::move(*segment), broker_inode, std::move(*doorbell)});
  install_error_guard(std::move(log), std::move(stop_asked));
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, name));
  joined = true;
  return Runtime(std::move(state));
}

Runtime::Runtime(std::unique_ptr<State> state) : state_(std::move(state)) {}
Runtime::Runtime(Runtime&&) noexcept = default;
Runtime& Runtime::operator=(Runtime&&) noexcept = default;

Runtime::~Runtime() {
  if (state_) forget_callbacks();
}

const std::string& Runtime::name() const {
  return state_->name;
}

const std::shared_ptr<Doorbell>& Runtime::doorbell() const {
  return state_->doorbell;
}

bool Runtime::broker_alive() const {
  return management_inode() == state_->broker_inode && broker_answers();
}

Expected<MemoryRange> Runtime::payload_segment() const {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    int path_at = 0;
    const int fields =
        std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %*s %*s %*s %*s %n", &begin, &end, &path_at);
    if (fields == 2 &&
        line.compare(static_cast<std::size_t>(path_at), std::string::npos, state_->segment) == 0) {
      return MemoryRange{reinterpret_cast<std::byte*>(begin), end - begin};
    }
  }
  return tl::unexpected(Error{ErrorKind::unavailable, state_->segment + " is not mapped in this process"});
}

Expected<std::size_t> Runtime::prefault() const {
  return payload_segment().and_then([](const MemoryRange& range) -> Expected<std::size_t> {
    if (::madvise(range.base, range.bytes, MADV_POPULATE_WRITE) == 0) return range.bytes;
    return tl::unexpected(
        Error{ErrorKind::unavailable, "cannot prefault " + std::to_string(range.bytes) +
                                          " bytes of shared memory: " + std::strerror(errno)});
  });
}

}  // namespace gvom::ipc
