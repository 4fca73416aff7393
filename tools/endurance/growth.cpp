#include "tools/endurance/growth.hpp"

#include <algorithm>

namespace gvom::endurance {

namespace {

double measured(std::vector<Point>::const_iterator begin, std::vector<Point>::const_iterator end,
                Measure measure) {
  std::vector<double> values;
  std::transform(begin, end, std::back_inserter(values), [](const Point& point) { return point.value; });
  return measure == Measure::median ? median(std::move(values))
                                    : *std::min_element(values.begin(), values.end());
}

}  // namespace

void Series::add(double at_s, double value) {
  if (++since_kept_ < stride_) return;
  since_kept_ = 0;
  points_.push_back({at_s, value});
  if (points_.size() < kMost) return;
  for (std::size_t i = 0; i < kMost / 2; ++i) points_[i] = points_[2 * i + 1];
  points_.resize(kMost / 2);
  stride_ *= 2;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::optional<Growth> growth_of(const Series& series, double from_s, Measure measure) {
  const auto& points = series.points();
  const auto begin = std::find_if(points.begin(), points.end(),
                                  [from_s](const Point& point) { return point.at_s >= from_s; });
  const auto count = static_cast<std::size_t>(points.end() - begin);
  if (count < kLeastSamples) return std::nullopt;
  const auto quarter = static_cast<std::ptrdiff_t>(count / 4);
  const auto most =
      std::max_element(begin, points.end(), [](const Point& a, const Point& b) { return a.value < b.value; });
  const double apart_s = (points.end() - 1 - quarter / 2)->at_s - (begin + quarter / 2)->at_s;
  return Growth{measured(begin, begin + quarter, measure),
                measured(points.end() - quarter, points.end(), measure), most->value, apart_s / 3600};
}

}  // namespace gvom::endurance
