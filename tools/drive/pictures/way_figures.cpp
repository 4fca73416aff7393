#include "tools/drive/pictures/way_figures.hpp"

#include <algorithm>
#include <numeric>

namespace gvom::driving {
namespace {

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double WayFigures::least_distance_m() const {
  return distance_m.empty() ? kFarthest_m : *std::min_element(distance_m.begin(), distance_m.end());
}

double WayFigures::mean_distance_m() const {
  return mean_of(distance_m);
}
double WayFigures::mean_cost() const {
  return mean_of(cost);
}

WayFigures measure_way(const planner::Costmap& costs, const std::vector<Eigen::Vector2d>& way_m) {
  WayFigures figures;
  double left_m = 0;  // to the next step
  for (std::size_t i = 0; i + 1 < way_m.size(); ++i) {
    const Eigen::Vector2d along = way_m[i + 1] - way_m[i];
    const double length_m = along.norm();
    for (; left_m < length_m; left_m += WayFigures::kStep_m) {
      const Eigen::Vector2d place = way_m[i] + along * (left_m / length_m);
      const int cell = costs.cells().index_of(place.x(), place.y());
      const double off_m = cell < 0 ? WayFigures::kFarthest_m : costs.distance_m()[cell];
      figures.distance_m.push_back(std::min(off_m, WayFigures::kFarthest_m));
      figures.cost.push_back(costs.smooth_cost(place.x(), place.y()));
    }
    left_m -= length_m;
  }
  return figures;
}

}  // namespace gvom::driving
