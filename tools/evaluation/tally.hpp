// Counting: shares in percent, and the spread of errors.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/evaluation/frame.hpp"

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

/// Near, to 30 m, anywhere.
struct ShareByRange {
  Share near, far, any;

  void count(double ahead_m, bool hit) {
    any.count(hit);
    if (ahead_m <= kFar_m) far.count(hit);
    if (ahead_m <= kNear_m) near.count(hit);
  }
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
