#include "tools/evaluation/figures.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace gvom::evaluation {

const std::array<FigureInfo, kFigures>& figure_table() {
  using F = Figure;
  constexpr Better kLower = Better::lower, kHigher = Better::higher, kNeither = Better::neither;
  static constexpr std::array<FigureInfo, kFigures> kTable = {{
      {F::negative_near, "negative_near", "false NEGATIVE, near", "%", 2, kLower},
      {F::negative_30, "negative_30", "false NEGATIVE, 30 m", "%", 2, kLower},
      {F::negative_any, "negative_any", "false NEGATIVE, anywhere", "%", 2, kLower},
      {F::hard_near, "hard_near", "false HARD, near", "%", 3, kLower},
      {F::hard_30, "hard_30", "false HARD, 30 m", "%", 3, kLower},
      {F::hard_any, "hard_any", "false HARD, anywhere", "%", 3, kLower},
      {F::steep_near, "steep_near", "false STEEP, near", "%", 2, kLower},
      {F::steep_30, "steep_30", "false STEEP, 30 m", "%", 2, kLower},
      {F::steep_any, "steep_any", "false STEEP, anywhere", "%", 2, kLower},
      {F::lethal_near, "lethal_near", "falsely lethal, near", "%", 2, kLower},
      {F::lethal_30, "lethal_30", "falsely lethal, 30 m", "%", 2, kLower},
      {F::lethal_any, "lethal_any", "falsely lethal, anywhere", "%", 2, kLower},
      {F::path_barred_15, "path_barred_15", "15 m path falsely barred", "%", 1, kLower},
      {F::path_barred_30, "path_barred_30", "30 m path falsely barred", "%", 1, kLower},
      {F::lethal_found_near, "lethal_found_near", "lethal columns found, near", "%", 1, kHigher},
      {F::hole_barred_m, "hole_barred_m", "hole barred from", "m", 1, kHigher},
      {F::hole_allowed_m, "hole_allowed_m", "hole: geometry allows", "m", 1, kNeither},
      {F::hole_ratio, "hole_ratio", "hole: share of what geometry allows", "", 2, kHigher},
      {F::bare_near_bias, "bare_near_bias_m", "height bias, bare ground near", "m", 3, kNeither},
      {F::bare_near_median, "bare_near_median_m", "height error median, bare ground near", "m", 3, kLower},
      {F::bare_near_p95, "bare_near_p95_m", "height error p95, bare ground near", "m", 3, kLower},
      {F::bare_bias, "bare_bias_m", "height bias, bare ground", "m", 3, kNeither},
      {F::bare_median, "bare_median_m", "height error median, bare ground", "m", 3, kLower},
      {F::bare_p95, "bare_p95_m", "height error p95, bare ground", "m", 3, kLower},
      {F::vegetation_bias, "vegetation_bias_m", "height bias, vegetation", "m", 3, kNeither},
      {F::vegetation_median, "vegetation_median_m", "height error median, vegetation", "m", 3, kLower},
      {F::vegetation_p95, "vegetation_p95_m", "height error p95, vegetation", "m", 3, kLower},
      {F::height_bias, "height_bias_m", "height bias, all", "m", 3, kNeither},
      {F::height_median, "height_median_m", "height error median, all", "m", 3, kLower},
      {F::height_p95, "height_p95_m", "height error p95, all", "m", 3, kLower},
      {F::trunks_ever, "trunks_ever", "trunks ever HARD while near", "%", 1, kHigher},
      {F::trunks_near, "trunks_near", "trunks HARD, near", "%", 1, kHigher},
      {F::trunks_30, "trunks_30", "trunks HARD, 30 m", "%", 1, kHigher},
      {F::walls_near, "walls_near", "wall columns HARD, near", "%", 1, kHigher},
      {F::cars_near, "cars_near", "car columns HARD, near", "%", 1, kHigher},
      {F::rocks_near, "rocks_near", "rock columns HARD, near", "%", 1, kHigher},
      {F::bushes_found, "bushes_found", "bush columns HARD or SOFT, near", "%", 1, kNeither},
      {F::bushes_soft, "bushes_soft", "bushes: SOFT of the obstacles, near", "%", 1, kHigher},
      {F::bushes_hard, "bushes_hard", "bushes: columns HARD, near", "%", 1, kLower},
      {F::crown_bushes_soft, "crown_bushes_soft", "bushes under crowns: SOFT of the obstacles, near", "%", 1,
       kHigher},
      {F::crown_bushes_hard, "crown_bushes_hard", "bushes under crowns: columns HARD, near", "%", 1, kLower},
      {F::grass_soft, "grass_soft", "grass: columns SOFT, near", "%", 1, kNeither},
      {F::grass_hard, "grass_hard", "grass: columns HARD, near", "%", 2, kLower},
      {F::walker_found, "walker_found", "walker near: frames that show it", "%", 1, kHigher},
      {F::trail_median_s, "trail_median_s", "walker's trail, median", "s", 2, kLower},
      {F::trail_p95_s, "trail_p95_s", "walker's trail, p95", "s", 2, kLower},
      {F::trail_max_s, "trail_max_s", "walker's trail, longest", "s", 2, kLower},
      {F::coverage_near, "coverage_near", "drivable ground with a height, near", "%", 1, kHigher},
      {F::coverage_30, "coverage_30", "drivable ground with a height, 30 m", "%", 1, kHigher},
      {F::sight_coverage_near, "sight_coverage_near", "the same of what is in sight, near", "%", 1, kHigher},
      {F::sight_coverage_30, "sight_coverage_30", "the same of what is in sight, 30 m", "%", 1, kHigher},
      {F::observed_negative_near, "observed_negative_near", "NEGATIVE of all observed, near", "%", 2, kLower},
      {F::observed_negative_30, "observed_negative_30", "NEGATIVE of all observed, 30 m", "%", 2, kLower},
      {F::observed_negative_any, "observed_negative_any", "NEGATIVE of all observed, anywhere", "%", 2,
       kLower},
      {F::real_trees_found, "real_trees_found", "real trees: columns HARD or SOFT", "%", 1, kNeither},
      {F::real_trees_hard, "real_trees_hard", "real trees: HARD of the obstacles", "%", 1, kHigher},
      {F::real_bushes_soft, "real_bushes_soft", "real bushes: columns not HARD", "%", 1, kHigher},
  }};
  return kTable;
}

Figures::Figures() {
  values_.fill(std::numeric_limits<double>::quiet_NaN());
}

std::string text_of(Figure figure, double value) {
  if (std::isnan(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", info_of(figure).digits, value);
  return text;
}

}  // namespace gvom::evaluation
