#include "tools/evaluation/tally.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::evaluation {
namespace {
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
}

double Share::percent() const {
  return of == 0 ? kUnknown : 100.0 * static_cast<double>(hits) / static_cast<double>(of);
}

double Spread::mean() const {
  if (values_.empty()) return kUnknown;
  double sum = 0.0;
  for (const float value : values_) sum += value;
  return sum / static_cast<double>(values_.size());
}

double Spread::quantile(double part) const {
  if (values_.empty()) return kUnknown;
  std::vector<float> sizes;
  sizes.reserve(values_.size());
  for (const float value : values_) sizes.push_back(std::abs(value));
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + at, sizes.end());
  return sizes[static_cast<std::size_t>(at)];
}

}  // namespace gvom::evaluation
