// Streams, events and graphs. Work is put off until somebody waits for it.
#include <utility>

#include "tests/fake_cuda/state.hpp"

using namespace fake_cuda;

namespace {

template <class T>
void require(const char* call, const std::set<T*>& all, T* one) {
  if (all.count(one) == 0) finding(call, "something that was not made, or is gone");
}

template <class T>
void forget(const char* call, std::set<T*>& all, T* one) {
  require(call, all, one);
  all.erase(one);
  delete one;
}

template <class T>
T* made(std::set<T*>& all, T* one) {
  all.insert(one);
  return one;
}

}  // namespace

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  if (flags != cudaStreamNonBlocking) finding(__func__, "a stream that waits for the default stream");
  *stream = made(state().streams, new FakeStream);
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  forget(__func__, state().streams, stream);
  return enter(__func__, InCapture::breaks);
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  require_stream(__func__, stream);
  FAKE_CUDA_ENTER(InCapture::breaks);
  ++state().counts.waits;
  run(stream);
  return give(state().sticky);
}

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  *event = made(state().events, new FakeEvent);
  return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event) {
  for (FakeStream* stream : state().streams) run(stream);  // which may yet record it
  forget(__func__, state().events, event);
  return enter(__func__, InCapture::breaks);
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  require(__func__, state().events, event);
  require_stream(__func__, stream);
  if (stream->capture != nullptr) finding(__func__, "in a capture: it would be of no use as a moment");
  event->recorded = true;
  event->done = false;
  enqueue(stream, [event] {
    event->done = true;
    event->at = std::chrono::steady_clock::now();
  });
  return cudaSuccess;
}

cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t from, cudaEvent_t to) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  require(__func__, state().events, from);
  require(__func__, state().events, to);
  if (!from->recorded || !to->recorded) return give(cudaErrorInvalidResourceHandle);
  if (!from->done || !to->done) return give(cudaErrorNotReady);
  *ms = std::chrono::duration<float, std::milli>(to->at - from->at).count();
  return cudaSuccess;
}

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode /*mode*/) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  require_stream(__func__, stream);
  stream->capture = made(state().graphs, new FakeGraph);
  stream->capture_broken = false;
  return cudaSuccess;
}

cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
  require_stream(__func__, stream);
  FakeGraph* captured = std::exchange(stream->capture, nullptr);
  *graph = nullptr;
  if (captured == nullptr) return give(cudaErrorIllegalState);
  const cudaError_t refusal = enter(__func__, InCapture::allowed);
  if (refusal == cudaSuccess && !stream->capture_broken) {
    *graph = captured;
    return cudaSuccess;
  }
  forget(__func__, state().graphs, captured);
  return refusal != cudaSuccess ? refusal : give(cudaErrorStreamCaptureInvalidated);
}

cudaError_t cudaGraphInstantiate(cudaGraphExec_t* playable, cudaGraph_t graph, unsigned long long /*flags*/) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  require(__func__, state().graphs, graph);
  *playable = made(state().playables, new FakePlayable{graph->operations});
  return cudaSuccess;
}

cudaError_t cudaGraphUpload(cudaGraphExec_t playable, cudaStream_t stream) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  require(__func__, state().playables, playable);
  require_stream(__func__, stream);
  return cudaSuccess;
}

cudaError_t cudaGraphLaunch(cudaGraphExec_t playable, cudaStream_t stream) {
  FAKE_CUDA_ENTER(InCapture::allowed, cudaErrorLaunchOutOfResources);
  require(__func__, state().playables, playable);
  require_stream(__func__, stream);
  for (const FakeOperation& operation : playable->operations) enqueue(stream, operation);
  return cudaSuccess;
}

cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  forget(__func__, state().graphs, graph);
  return enter(__func__, InCapture::allowed);
}

cudaError_t cudaGraphExecDestroy(cudaGraphExec_t playable) {
  if (playable == nullptr) return give(cudaErrorInvalidValue);
  forget(__func__, state().playables, playable);
  return enter(__func__, InCapture::allowed);
}
