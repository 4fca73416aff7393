// Random numbers that are the same with every standard library.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>

namespace gvom::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// low .. high, both included.
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  template <class T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[integer(0, static_cast<int>(choices.size()) - 1)];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gvom::test
