// core/cuda/device.hpp and scan.hpp without a GPU: memory of the host, and kernels run one index after the
// other. As on a device nothing is done before `wait`: what the host changes too early comes out wrong.
#include "tests/serial_device/serial_device.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/scan.hpp"

namespace gvom::cuda {

namespace {

constexpr std::size_t kAlignment = 256;
constexpr int kPoison = 0xA5;  // what memory holds that nobody has written

std::uint64_t fail_at_from_environment() {
  const char* set = std::getenv("GVOM_SERIAL_DEVICE_FAIL_AT");
  return set == nullptr ? 0 : std::strtoull(set, nullptr, 10);
}

bool shares_host_memory = false;
bool refuses_to_pin = false;
std::uint64_t failing_operation = fail_at_from_environment();
std::uint64_t allocation_count = 0;
std::uint64_t wait_count = 0;

using Operation = std::function<void()>;

struct RecordedGraph {
  std::vector<Operation> operations;
  std::uint64_t launches = 0;
};

bool holds(const HostMemory& memory, const void* at) {
  const auto* begin = static_cast<const std::byte*>(memory.base);
  const auto* byte = static_cast<const std::byte*>(at);
  return byte >= begin && byte < begin + memory.bytes;
}

void* aligned_memory(std::size_t bytes) {
  return std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
}

}  // namespace

namespace serial {

void share_host_memory(bool shares) {
  shares_host_memory = shares;
}

void refuse_to_pin(bool refuses) {
  refuses_to_pin = refuses;
}

void fail_at(std::uint64_t operation) {
  failing_operation = operation;
}

std::uint64_t allocations() {
  return allocation_count;
}

std::uint64_t waits() {
  return wait_count;
}

}  // namespace serial

struct Device::State {
  DeviceInfo info{"serial device on the host", 0, 0, 1, shares_host_memory};
  std::vector<HostMemory> memory;
  HostMemory pinned;
  std::vector<Operation> pending;
  std::vector<Operation>* recording = nullptr;
  std::vector<RecordedGraph> graphs;
  std::chrono::steady_clock::time_point moments[kMoments]{};
  std::uint64_t launches = 0;
  std::uint64_t done = 0;
  std::string failure;

  void enqueue(Operation operation) {
    if (!failure.empty()) return;
    (recording != nullptr ? *recording : pending).push_back(std::move(operation));
  }

  void run(const Operation& operation) {
    if (failure.empty() && ++done == failing_operation) failure = "an injected fault of the serial device";
    if (failure.empty()) operation();
  }
};

DeviceExpected<std::unique_ptr<Device>> Device::open() {
  return std::unique_ptr<Device>(new Device(std::make_unique<State>()));
}

Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}

Device::~Device() {
  for (const HostMemory& memory : state_->memory) std::free(memory.base);
}

const DeviceInfo& Device::info() const {
  return state_->info;
}

void* Device::allocate(std::size_t bytes) {
  void* memory = allocate_pinned(bytes);
  if (memory != nullptr) clear(memory, bytes);
  return memory;
}

void* Device::allocate_pinned(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  ++allocation_count;
  void* memory = aligned_memory(bytes);
  std::memset(memory, kPoison, bytes);
  state_->memory.push_back({memory, bytes});
  return memory;
}

DeviceExpected<void> Device::pin(const HostMemory& memory) {
  if (refuses_to_pin) return tl::make_unexpected(DeviceError{"the serial device was told to refuse"});
  state_->pinned = memory;
  return {};
}

const void* Device::in_place(const void* host) const {
  return state_->info.shares_host_memory && holds(state_->pinned, host) ? host : nullptr;
}

// Memory that is not pinned goes through staging memory at once, as with the driver.
void Device::upload(void* to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  const auto holds_it = [from](const HostMemory& memory) { return holds(memory, from); };
  if (holds_it(state_->pinned) || std::any_of(state_->memory.begin(), state_->memory.end(), holds_it))
    return state_->enqueue([=] { std::memcpy(to, from, bytes); });
  const auto* begin = static_cast<const std::byte*>(from);
  state_->enqueue([to, staged = std::vector<std::byte>(begin, begin + bytes)] {
    std::memcpy(to, staged.data(), staged.size());
  });
}

void Device::download(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) state_->enqueue([=] { std::memcpy(to, from, bytes); });
}

void Device::copy(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) state_->enqueue([=] { std::memcpy(to, from, bytes); });
}

void Device::clear(void* begin, std::size_t bytes) {
  if (bytes > 0) state_->enqueue([=] { std::memset(begin, 0, bytes); });
}

Device::Graph Device::record(const std::function<void()>& describe) {
  RecordedGraph graph;
  const std::uint64_t before = state_->launches;
  state_->recording = &graph.operations;
  describe();
  state_->recording = nullptr;
  graph.launches = std::exchange(state_->launches, before) - before;
  state_->graphs.push_back(std::move(graph));
  return state_->graphs.size() - 1;
}

void Device::play(Graph graph) {
  for (const Operation& operation : state_->graphs[graph].operations) state_->enqueue(operation);
  state_->launches += state_->graphs[graph].launches;
}

void Device::mark(int moment) {
  state_->enqueue([this, moment] { state_->moments[moment] = std::chrono::steady_clock::now(); });
}

double Device::ms_between(int earlier, int later) const {
  return std::chrono::duration<double, std::milli>(state_->moments[later] - state_->moments[earlier]).count();
}

DeviceExpected<void> Device::wait() {
  ++wait_count;
  for (const Operation& operation : std::exchange(state_->pending, {})) state_->run(operation);
  if (failed()) return tl::make_unexpected(failure());
  return {};
}

void Device::fail(const std::string& what) {
  if (state_->failure.empty()) state_->failure = what;
}

bool Device::failed() const {
  return !state_->failure.empty();
}

DeviceError Device::failure() const {
  return {state_->failure};
}

std::uint64_t Device::launches() const {
  return state_->launches;
}

void* Device::stream() const {
  return nullptr;
}

void Device::note_launch(int /*error*/, int kernels) {
  state_->launches += static_cast<std::uint64_t>(kernels);
}

void Device::run_serially(std::function<void()> kernel) {
  ++state_->launches;
  state_->enqueue(std::move(kernel));
}

Scan::Scan(Device& device, std::size_t count) : device_(device), count_(count) {}

void Scan::exclusive_sum(const std::uint64_t* values, std::uint64_t* starts) {
  device_.run_serially(
      [=, count = count_] { std::exclusive_scan(values, values + count, starts, std::uint64_t{0}); });
}

}  // namespace gvom::cuda
