#include "services/planner/distance.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::planner {

DistanceTransform::DistanceTransform(int n_xy)
    : rows_(static_cast<std::size_t>(n_xy) * n_xy), squared_(n_xy), apexes_(n_xy), begins_(n_xy + 1) {}

void DistanceTransform::run(const std::uint8_t* marked, int n, double cell_m, float* distance_m) {
  count_rows(marked, n);
  const auto cell = static_cast<float>(cell_m);
  for (int y = 0; y < n; ++y) {
    float* const out = distance_m + y * n;
    if (square_row(rows_.data() + y * n, n)) {
      for (int x = 0; x < n; ++x) out[x] = cell * std::sqrt(static_cast<float>(squared_[x]));
    } else {
      std::fill(out, out + n, kFar_m);
    }
  }
}

// In a column without a marked cell: 2 n or more, farther than anything is.
void DistanceTransform::count_rows(const std::uint8_t* marked, int n) {
  std::int32_t* const rows = rows_.data();
  for (int x = 0; x < n; ++x) rows[x] = marked[x] ? 0 : 2 * n;
  for (int y = 1; y < n; ++y) {
    for (int i = y * n; i < (y + 1) * n; ++i) rows[i] = marked[i] ? 0 : rows[i - n] + 1;
  }
  for (int y = n - 2; y >= 0; --y) {
    for (int i = y * n; i < (y + 1) * n; ++i) rows[i] = std::min(rows[i], rows[i + n] + 1);
  }
}

bool DistanceTransform::square_row(const std::int32_t* rows, int n) {
  int last = -1;
  for (int x = 0; x < n; ++x) {
    if (rows[x] >= n) continue;
    double begin = 0;
    for (; last >= 0; --last) {
      const int apex = apexes_[last];
      const int rise = rows[x] * rows[x] + x * x - rows[apex] * rows[apex] - apex * apex;
      begin = static_cast<double>(rise) / (2 * (x - apex));
      if (begin > begins_[last]) break;
    }
    ++last;
    apexes_[last] = x;
    begins_[last] = last == 0 ? -1 : begin;
  }
  if (last < 0) return false;
  int x = 0;
  for (int k = 0; k <= last; ++k) {
    const int apex = apexes_[k], height = rows[apex] * rows[apex];
    const int end = k == last || begins_[k + 1] >= n ? n : static_cast<int>(std::ceil(begins_[k + 1]));
    for (; x < end; ++x) squared_[x] = (x - apex) * (x - apex) + height;
  }
  return true;
}

}  // namespace gvom::planner
