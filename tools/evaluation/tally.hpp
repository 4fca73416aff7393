// Counting: shares in percent, and the spread of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace gvom::evaluation {

struct Share {
  std::size_t hits = 0;
  std::size_t of = 0;

  void count(bool hit) {
    hits += hit;
    ++of;
  }
  /// NaN where nothing was counted.
  [[nodiscard]] double percent() const;
};

/// Values of which the mean and quantiles are asked.
class Spread {
 public:
  void add(float value) { values_.push_back(value); }
  [[nodiscard]] double mean() const;
  /// Of the absolute values, `part` 0 .. 1; NaN where there is none, as above.
  [[nodiscard]] double quantile(double part) const;

 private:
  std::vector<float> values_;
};

}  // namespace gvom::evaluation
