#include "tools/evaluation/goals.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace gvom::evaluation {
namespace {

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool is_about(const Goal& goal, const Row& row) {
  if (goal.sensor[0] != '\0' && row.sensor != goal.sensor) return false;
  if (goal.scenes[0] == '\0') return true;
  const bool but = goal.scenes[0] == '-';
  std::stringstream names(goal.scenes + but);
  for (std::string name; std::getline(names, name, ',');)
    if (begins_with(row.scene, name)) return !but;
  return but;
}

bool is_worse(Figure figure, double a, double b) {
  return info_of(figure).better == Better::lower ? a > b : a < b;
}

}  // namespace

const std::vector<Goal>& goals() {
  static const std::vector<Goal> kGoals = {
      {"false NEGATIVE, near (%)", Figure::negative_near, "-puddles,ramp-sharp", "", 0.3},
      {"false NEGATIVE, 30 m (%)", Figure::negative_30, "-puddles,ramp-sharp", "", 0.5},
      {"false NEGATIVE, anywhere (%)", Figure::negative_any, "-puddles,ramp-sharp", "", 1.0},
      {"30 m path falsely barred (% of frames)", Figure::path_barred_30, "-ramp-sharp", "", 2.0},
      {"ditch of 2 m barred from, OS1-64 (m)", Figure::hole_barred_m, "ditch-2m", "os1-64", 13.0},
      {"ditch of 2 m barred from, OS1-128 (m)", Figure::hole_barred_m, "ditch-2m", "os1-128", 19.0},
      {"cliff barred from, OS1-64 (m)", Figure::hole_barred_m, "cliff", "os1-64", 16.0},
      {"bank down barred from, OS1-64 (m)", Figure::hole_barred_m, "bank-down", "os1-64", 16.0},
      {"ditch of 1 m barred from, OS1-64 (m)", Figure::hole_barred_m, "ditch-1m", "os1-64", 9.5},
      {"height error p95, bare ground (m)", Figure::bare_p95, "", "", 0.08},
      {"height error p95, under vegetation (m)", Figure::vegetation_p95, "", "", 0.3},
      {"height error p95, forest (m)", Figure::height_p95, "forest", "", 0.15},
      {"trunks of 0.15 m HARD, near (%)", Figure::trunks_near, "", "", 100.0},
      {"trunks of 0.15 m HARD, 30 m (%)", Figure::trunks_30, "", "", 99.0},
      {"bushes SOFT, near (%)", Figure::bushes_soft, "", "", 98.0},
      {"bushes under crowns SOFT, near (%)", Figure::crown_bushes_soft, "", "", 85.0},
      {"cars HARD, near (%)", Figure::cars_near, "", "", 80.0},
      {"walls HARD, near (%)", Figure::walls_near, "", "", 95.0},
      {"rocks HARD, near (%)", Figure::rocks_near, "", "", 80.0},
      {"dust and rain falsely HARD, near (%)", Figure::hard_near, "dust,rain", "", 0.02},
      {"walker's trail, p95 (s)", Figure::trail_p95_s, "", "", 0.3},
  };
  return kGoals;
}

const std::vector<Goal>& real_goals() {
  static const std::vector<Goal> kGoals = {
      {"RELLIS, both lidars: tree columns HARD (%)", Figure::real_trees_hard, "rellis", "both", 70.0},
      {"RELLIS, both lidars: bushes not HARD (%)", Figure::real_bushes_soft, "rellis", "both", 95.0},
      {"KITTI: NEGATIVE of all observed, 30 m (%)", Figure::observed_negative_30, "kitti", "", 0.5},
      {"KITTI: HARD on the car's way (%)", Figure::hard_any, "kitti", "", 0.0},
      {"KITTI: STEEP on the car's way (%)", Figure::steep_any, "kitti", "", 0.0},
  };
  return kGoals;
}

const Row* worst_row(const Goal& goal, const std::vector<Row>& rows, const std::string& drive) {
  const Row* worst = nullptr;
  for (const Row& row : rows) {
    const double value = row.figures[goal.figure];
    if (row.drive != drive || std::isnan(value) || !is_about(goal, row)) continue;
    if (worst == nullptr || is_worse(goal.figure, value, worst->figures[goal.figure])) worst = &row;
  }
  return worst;
}

bool reaches(const Goal& goal, double value) {
  const double printed = std::strtod(text_of(goal.figure, value).c_str(), nullptr);
  return !is_worse(goal.figure, printed, goal.value);
}

}  // namespace gvom::evaluation
