#include "ipc/freshness.hpp"

#include <algorithm>
#include <cstdio>

#include "ipc/runtime.hpp"

namespace gvom::ipc {

Moment Moment::now() {
  return {monotonic_ns(), gvom::ipc::suspended_ns()};
}

Moment received_at(const Layers& layers) {
  return {layers.mono_received_ns, layers.suspended_ns};
}

Moment received_at(const BrickMap& map) {
  return {map.mono_received_ns, map.suspended_ns};
}

std::chrono::nanoseconds elapsed(const Moment& then, const Moment& now) {
  if (then.mono_ns <= 0 || then.mono_ns > now.mono_ns) return kUnknownAge;
  const std::int64_t suspended_ns = std::max<std::int64_t>(0, now.suspended_ns - then.suspended_ns);
  return std::chrono::nanoseconds(now.mono_ns - then.mono_ns + suspended_ns);
}

std::string age_words(std::chrono::nanoseconds age) {
  if (age == kUnknownAge) return "of unknown age: they do not say when their packets came, or it is to come";
  char words[48];
  std::snprintf(words, sizeof words, "%.1f s old", std::chrono::duration<double>(age).count());
  return words;
}

}  // namespace gvom::ipc
