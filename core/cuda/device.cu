#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/kernel_clock.hpp"

namespace gvom::cuda {

namespace {

// The device is to be busy until all kernels of a tick are sent: else their times count the sending.
constexpr std::size_t kDelayBytes = std::size_t{128} << 20;

// `call` may have its arguments behind it, which say nothing to people.
std::string words(const std::string& call, cudaError_t error) {
  return call.substr(0, call.find('(')) + ": " + cudaGetErrorString(error);
}

std::string cuda_version(int number) {
  return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10);
}

// Why the driver cannot be used at all: the runtime has the same words for none and for an old one.
std::string driver_words() {
  int speaks = 0;
  int needed = 0;
  if (cudaDriverGetVersion(&speaks) != cudaSuccess || speaks == 0) return "no NVIDIA driver";
  cudaRuntimeGetVersion(&needed);
  return "the NVIDIA driver is too old: it runs programs of CUDA " + cuda_version(speaks) +
         ", this is one of " + cuda_version(needed);
}

struct PlayableGraph {
  cudaGraphExec_t exec = nullptr;
  std::uint64_t launches = 0;
  std::function<void()> describe;  // in place of `exec` where kernels are timed
};

}  // namespace

struct Device::State {
  DeviceInfo info{};
  cudaStream_t stream = nullptr;
  std::array<cudaEvent_t, kMoments> moments{};
  std::array<bool, kMoments> noted{};
  std::vector<void*> device_memory;
  std::vector<void*> pinned_memory;
  std::vector<void*> pinned_ranges;
  std::vector<PlayableGraph> graphs;
  std::uint64_t launches = 0;
  KernelClock clock;
  void* delay = nullptr;  // memory whose clearing takes as long as sending the kernels that are timed
  std::string failure;

  // Keeps the first error, and takes it from the runtime, which would tell it again to whoever asks next.
  // True if there is none.
  bool check(const char* call, cudaError_t error) {
    if (error != cudaSuccess) cudaGetLastError();
    if (error != cudaSuccess && failure.empty()) failure = words(call, error);
    return failure.empty();
  }
  [[nodiscard]] bool good() const { return failure.empty(); }

  void start();
  void capture(const std::function<void()>& describe, PlayableGraph& playable);
};

// Every call is checked, and none is made after the first that failed.
#define GVOM_CUDA(call) (state_->good() && state_->check(#call, call))

void Device::State::start() {
  setenv("CUDA_MODULE_LOADING", "EAGER", 0);  // kernels are loaded now, not at the first tick that needs them
  int count = 0;
  const cudaError_t counted = cudaGetDeviceCount(&count);
  if (counted == cudaErrorInsufficientDriver) failure = driver_words();
  if (!check("looking for a CUDA device", counted)) return;
  if (!check("taking the first CUDA device", cudaSetDevice(0))) return;
  cudaDeviceProp properties{};
  if (!check("asking the CUDA device what it is", cudaGetDeviceProperties(&properties, 0))) return;
  info.name = properties.name;
  info.compute_capability = 10 * properties.major + properties.minor;
  info.multiprocessors = properties.multiProcessorCount;
  info.shares_host_memory = properties.integrated != 0;
  if (!check("asking for the driver's version", cudaDriverGetVersion(&info.driver_version))) return;
  if (!check("making a CUDA stream", cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking))) return;
  for (cudaEvent_t& moment : moments)
    if (!check("making a CUDA event", cudaEventCreate(&moment))) return;
}

DeviceExpected<std::unique_ptr<Device>> Device::open() {
  auto state = std::make_unique<State>();
  state->start();
  std::unique_ptr<Device> device(new Device(std::move(state)));
  if (device->failed()) return tl::make_unexpected(device->failure());
  return device;
}

Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}

// Errors are of no more use to anybody here.
Device::~Device() {
  if (state_->stream != nullptr) cudaStreamSynchronize(state_->stream);
  for (const PlayableGraph& graph : state_->graphs)
    if (graph.exec != nullptr) cudaGraphExecDestroy(graph.exec);
  for (void* range : state_->pinned_ranges) cudaHostUnregister(range);
  for (void* memory : state_->device_memory) cudaFree(memory);
  for (void* memory : state_->pinned_memory) cudaFreeHost(memory);
  for (cudaEvent_t moment : state_->moments)
    if (moment != nullptr) cudaEventDestroy(moment);
  if (state_->stream != nullptr) cudaStreamDestroy(state_->stream);
}

const DeviceInfo& Device::info() const {
  return state_->info;
}

void* Device::allocate(std::size_t bytes) {
  void* memory = nullptr;
  if (bytes == 0 || !GVOM_CUDA(cudaMalloc(&memory, bytes))) return nullptr;
  state_->device_memory.push_back(memory);
  return memory;
}

void Device::release(void* memory) {
  auto& all = state_->device_memory;
  const auto place = std::find(all.begin(), all.end(), memory);
  if (place == all.end()) return;
  all.erase(place);
  GVOM_CUDA(cudaFree(memory));
}

void* Device::allocate_pinned(std::size_t bytes) {
  void* memory = nullptr;
  if (bytes == 0 || !GVOM_CUDA(cudaMallocHost(&memory, bytes))) return nullptr;
  state_->pinned_memory.push_back(memory);
  return memory;
}

DeviceExpected<void> Device::pin(const HostMemory& memory) {
  constexpr unsigned kFlags = cudaHostRegisterPortable | cudaHostRegisterMapped;
  cudaPointerAttributes attributes{};
  if (!GVOM_CUDA(cudaPointerGetAttributes(&attributes, memory.base))) return tl::make_unexpected(failure());
  if (attributes.type == cudaMemoryTypeHost) return {};  // by another device object of this process
  const cudaError_t error = cudaHostRegister(memory.base, memory.bytes, kFlags);
  if (error != cudaSuccess) {
    cudaGetLastError();  // refused, not broken
    return tl::make_unexpected(DeviceError{words("cudaHostRegister", error)});
  }
  state_->pinned_ranges.push_back(memory.base);
  return {};
}

const void* Device::in_place(const void* host) const {
  if (!state_->info.shares_host_memory) return nullptr;
  void* device = nullptr;
  const cudaError_t error = cudaHostGetDevicePointer(&device, const_cast<void*>(host), 0);
  if (error == cudaSuccess) return device;
  if (error == cudaErrorInvalidValue)
    cudaGetLastError();  // not pinned
  else
    state_->check("cudaHostGetDevicePointer", error);
  return nullptr;
}

void Device::upload(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) GVOM_CUDA(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, state_->stream));
}

void Device::download(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) GVOM_CUDA(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, state_->stream));
}

void Device::copy(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) GVOM_CUDA(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, state_->stream));
}

void Device::clear(void* begin, std::size_t bytes) {
  if (bytes > 0) GVOM_CUDA(cudaMemsetAsync(begin, 0, bytes, state_->stream));
}

Device::Graph Device::record(const std::function<void()>& describe) {
  PlayableGraph playable;
  if (state_->clock.runs())
    playable.describe = describe;
  else
    state_->capture(describe, playable);
  state_->graphs.push_back(playable);
  return state_->graphs.size() - 1;
}

void Device::State::capture(const std::function<void()>& describe, PlayableGraph& playable) {
  if (!good()) return;
  const std::uint64_t before = launches;
  cudaGraph_t graph = nullptr;
  if (!check("cudaStreamBeginCapture", cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal)))
    return;
  describe();
  check("cudaStreamEndCapture", cudaStreamEndCapture(stream, &graph));
  if (good()) check("cudaGraphInstantiate", cudaGraphInstantiate(&playable.exec, graph, 0));
  if (good()) check("cudaGraphUpload", cudaGraphUpload(playable.exec, stream));
  if (graph != nullptr) cudaGraphDestroy(graph);
  playable.launches = std::exchange(launches, before) - before;
}

void Device::play(Graph graph) {
  const PlayableGraph& playable = state_->graphs[graph];
  if (playable.describe) return playable.describe();
  if (GVOM_CUDA(cudaGraphLaunch(playable.exec, state_->stream))) state_->launches += playable.launches;
}

void Device::mark(int moment) {
  const auto i = static_cast<std::size_t>(moment);
  if (GVOM_CUDA(cudaEventRecord(state_->moments[i], state_->stream))) state_->noted[i] = true;
}

double Device::ms_between(int earlier, int later) const {
  const auto from = static_cast<std::size_t>(earlier), to = static_cast<std::size_t>(later);
  float ms = 0;
  if (!state_->good() || !state_->noted[from] || !state_->noted[to]) return 0;
  if (cudaEventElapsedTime(&ms, state_->moments[from], state_->moments[to]) == cudaSuccess)
    return static_cast<double>(ms);
  cudaGetLastError();  // not done yet
  return 0;
}

DeviceExpected<void> Device::wait() {
  if (GVOM_CUDA(cudaStreamSynchronize(state_->stream))) return {};
  return tl::make_unexpected(failure());
}

void Device::fail(const std::string& what) {
  if (state_->good()) state_->failure = what;
}

bool Device::failed() const {
  return !state_->good();
}

DeviceError Device::failure() const {
  return {state_->failure};
}

std::uint64_t Device::launches() const {
  return state_->launches;
}

void* Device::stream() const {
  return state_->stream;
}

void Device::time_kernels() {
  state_->delay = array<std::byte>(kDelayBytes);
  state_->clock.start();
}

std::vector<KernelTime> Device::take_kernel_times() {
  std::vector<KernelTime> times;
  GVOM_CUDA(state_->clock.take(times));
  return times;
}

void Device::begin_kernel(const char* type) {
  if (!state_->clock.runs()) return;
  if (state_->clock.is_first()) clear(state_->delay, kDelayBytes);
  GVOM_CUDA(state_->clock.begin(type, state_->stream));
}

void Device::note_launch(int error, int kernels) {
  state_->launches += static_cast<std::uint64_t>(kernels);
  state_->check("launching a kernel", static_cast<cudaError_t>(error));
  if (state_->clock.runs() && kernels > 0) GVOM_CUDA(state_->clock.end(state_->stream));
}

}  // namespace gvom::cuda
