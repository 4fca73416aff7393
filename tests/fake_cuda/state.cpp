#include "tests/fake_cuda/state.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace fake_cuda {

State& state() {
  static State state = [] {
    State first;
    const char* set = std::getenv("GVOM_SERIAL_DEVICE_FAIL_AT");
    if (set != nullptr) first.failing_operation = std::strtoull(set, nullptr, 10);
    return first;
  }();
  return state;
}

void share_host_memory(bool shares) {
  state().shares_host_memory = shares;
}

void refuse_to_pin(bool refuses) {
  state().refuses_to_pin = refuses;
}

void set_multiprocessors(int count) {
  state().multiprocessors = count;
}

void lack(Absent what) {
  state().absent = what;
}

void set_order(Order order) {
  state().order = order;
}

void fail_at(std::uint64_t operation) {
  state().failing_operation = operation;
  state().sticky = state().last = cudaSuccess;
}

void refuse_call(std::uint64_t call) {
  state().refused_in = call;
  state().refused.clear();
}

std::string refused_call() {
  return state().refused;
}

Counts counts() {
  return state().counts;
}

std::string leftovers() {
  std::string words;
  const auto note = [&words](std::size_t count, const char* what) {
    if (count > 0) words += std::to_string(count) + " " + what + "; ";
  };
  const State& s = state();
  note(s.device_memory.size(), "pieces of device memory"), note(s.pinned.size(), "pieces of pinned memory");
  note(s.registered.size(), "registered ranges"), note(s.streams.size(), "streams");
  note(s.events.size(), "events"), note(s.graphs.size(), "graphs"),
      note(s.playables.size(), "playable graphs");
  return words;
}

std::size_t device_bytes() {
  std::size_t sum = 0;
  for (const auto& [begin, bytes] : state().device_memory) sum += bytes;
  return sum;
}

void set_observer(Observer* observer) {
  state().observer = observer;
}

bool is_device_memory(const void* at) {
  return within(state().device_memory, at, 1);
}

void throw_findings(bool throws) {
  state().throws = throws;
}

void finding(const char* call, const std::string& what) {
  if (state().throws) throw std::logic_error(std::string(call) + ": " + what);
  std::fprintf(stderr, "fake CUDA: %s: %s\n", call, what.c_str());
  std::abort();
}

cudaError_t give(cudaError_t error) {
  if (error != cudaSuccess) state().last = error;
  return error;
}

cudaError_t enter(const char* call, InCapture in_capture, cudaError_t refusal) {
  State& s = state();
  if (s.sticky != cudaSuccess) return give(s.sticky);
  if (s.refused_in > 0 && --s.refused_in == 0) {
    s.refused = call;
    return give(refusal);
  }
  bool breaks = false;
  for (FakeStream* stream : s.streams)
    if (in_capture == InCapture::breaks && stream->capture != nullptr) breaks = stream->capture_broken = true;
  return breaks ? give(cudaErrorStreamCaptureUnsupported) : cudaSuccess;
}

bool within(const Ranges& ranges, const void* at, std::size_t bytes) {
  const auto* begin = static_cast<const std::byte*>(at);
  const auto after = ranges.upper_bound(begin);
  if (after == ranges.begin()) return false;
  const auto& [first, size] = *std::prev(after);
  return begin + bytes <= first + size;
}

bool locked(const void* at, std::size_t bytes) {
  return within(state().pinned, at, bytes) || within(state().registered, at, bytes);
}

void enqueue(FakeStream* stream, FakeOperation operation) {
  (stream->capture != nullptr ? stream->capture->operations : stream->pending)
      .push_back(std::move(operation));
}

void run(FakeStream* stream) {
  State& s = state();
  for (const FakeOperation& operation : std::exchange(stream->pending, {})) {
    if (s.sticky != cudaSuccess) return;
    operation();
    if (s.failing_operation > 0 && --s.failing_operation == 0) s.sticky = cudaErrorIllegalAddress;
  }
}

void require_stream(const char* call, FakeStream* stream) {
  if (state().streams.count(stream) == 0) finding(call, "not a stream: the default one, or one that is gone");
}

}  // namespace fake_cuda
