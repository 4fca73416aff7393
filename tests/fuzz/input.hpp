// A fuzz input, taken apart from its front; and what must hold, whatever the input is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/sweep.hpp"
#include "services/ingest/fragments.hpp"

namespace gvom::fuzz {

/// Ends the process, so that libFuzzer keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Beyond its end there is nothing: zeros, and empty stretches.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  [[nodiscard]] bool empty() const { return left_ == 0; }

  ingest::Bytes take(std::size_t size) {
    const ingest::Bytes taken{data_, std::min(size, left_)};
    data_ += taken.size;
    left_ -= taken.size;
    return taken;
  }
  ingest::Bytes rest() { return take(left_); }

  template <typename T>
  T value() {
    T value{};
    const ingest::Bytes bytes = take(sizeof value);
    std::memcpy(&value, bytes.data, bytes.size);
    return value;
  }
  std::uint8_t byte() { return value<std::uint8_t>(); }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

inline std::string text_of(ingest::Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data), bytes.size};
}

/// What every sweep that a source hands out must be.
inline void check_sweep(const Sweep& sweep, std::size_t max_returns) {
  require(!sweep.times_ns.empty(), "a sweep has a time");
  require(sweep.returns.size() <= max_returns, "a sweep has at most max_returns");
  for (const Return& r : sweep.returns) {
    require(r.time_index < sweep.times_ns.size(), "a return's time is one of the sweep's");
  }
}

}  // namespace gvom::fuzz
