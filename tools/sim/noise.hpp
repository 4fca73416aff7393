// Random numbers that are the same bytes on every machine and for every number of threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace gvom::sim {

/// A well-mixed function of 64 bits (multiply and shift rounds after splitmix64).
inline std::uint64_t mix(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15ULL;
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9ULL;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBULL;
  return value ^ (value >> 31);
}

/// The key of a sub-stream: a counter instead of a state, so that order does not matter.
inline std::uint64_t derive(std::uint64_t key, std::uint64_t counter) {
  return mix(key ^ mix(counter));
}

/// 0 <= u < 1.
inline double uniform(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Nearly normal, mean 0, standard deviation 1, within +-3.5: the sum of four 16-bit uniforms, so it
/// needs no function of the C library.
inline double normal(std::uint64_t bits) {
  const std::uint64_t sum = (bits & 0xFFFF) + (bits >> 16 & 0xFFFF) + (bits >> 32 & 0xFFFF) + (bits >> 48);
  return (static_cast<double>(sum) / 65535.0 - 2.0) * 1.7320508075688772;
}

/// A sequential stream, for what is made once, in order.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double between(double low, double high) { return low + (high - low) * uniform(engine_()); }
  double normal() { return sim::normal(engine_()); }
  int count(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gvom::sim
