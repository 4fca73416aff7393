// What is measured: the figures of one drive through one scene with one sensor.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace gvom::evaluation {

/// In the order of the files. What each means stands in figures.cpp, for people in tools/README.md.
enum class Figure : std::size_t {
  negative_near,
  negative_30,
  negative_any,
  hard_near,
  hard_30,
  hard_any,
  steep_near,
  steep_30,
  steep_any,
  lethal_near,
  lethal_30,
  lethal_any,
  path_barred_15,
  path_barred_30,
  lethal_found_near,
  hole_barred_m,
  hole_allowed_m,
  hole_ratio,
  bare_near_bias,
  bare_near_median,
  bare_near_p95,
  bare_bias,
  bare_median,
  bare_p95,
  vegetation_bias,
  vegetation_median,
  vegetation_p95,
  height_bias,
  height_median,
  height_p95,
  trunks_ever,
  trunks_near,
  trunks_30,
  walls_near,
  cars_near,
  rocks_near,
  bushes_found,
  bushes_soft,
  bushes_hard,
  crown_bushes_soft,
  crown_bushes_hard,
  grass_soft,
  grass_hard,
  walker_found,
  trail_median_s,
  trail_p95_s,
  trail_max_s,
  coverage_near,
  coverage_30,
  sight_coverage_near,
  sight_coverage_30,
  observed_negative_near,
  observed_negative_30,
  observed_negative_any,
  real_trees_found,
  real_trees_hard,
  real_bushes_soft,
};
inline constexpr std::size_t kFigures = static_cast<std::size_t>(Figure::real_bushes_soft) + 1;

enum class Better { lower, higher, neither };

struct FigureInfo {
  Figure figure;
  const char* key;    ///< In files.
  const char* title;  ///< For people.
  const char* unit;   ///< "%", "m", "s" or "".
  int digits;         ///< After the point, wherever it is printed.
  Better better;
};

/// In the order of `Figure`.
const std::array<FigureInfo, kFigures>& figure_table();
inline const FigureInfo& info_of(Figure figure) {
  return figure_table()[static_cast<std::size_t>(figure)];
}

/// NaN where there was nothing to measure.
class Figures {
 public:
  Figures();
  double& operator[](Figure figure) { return values_[static_cast<std::size_t>(figure)]; }
  double operator[](Figure figure) const { return values_[static_cast<std::size_t>(figure)]; }

 private:
  std::array<double, kFigures> values_;
};

/// As it is printed: rounded to the figure's digits, "-" for NaN.
std::string text_of(Figure figure, double value);

inline constexpr const char* kRealDrive = "real";

/// One line of the table.
struct Row {
  std::string scene;
  std::string sensor;
  std::string drive;  ///< "trail" or "fast"; of a recording `kRealDrive`.
  Figures figures;

  [[nodiscard]] std::string name() const { return scene + " " + sensor + " " + drive; }
};

}  // namespace gvom::evaluation
