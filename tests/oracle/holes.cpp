#include "tests/oracle/holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace gvom::oracle {

namespace {

struct RimHeight {
  int k;
  double z_m;
};

// A line fitted to heights over whole numbers.
struct Fit {
  bool defined = false;
  double slope_m = 0, first_m = 0, rms_m = 0;

  explicit Fit(const std::vector<RimHeight>& rims) {
    std::set<int> places;
    std::int64_t n = 0, k = 0, kk = 0;
    double z = 0, kz = 0, zz = 0;
    for (const RimHeight& rim : rims) {
      places.insert(rim.k);
      n += 1, k += rim.k, kk += std::int64_t{rim.k} * rim.k;
      z += rim.z_m, kz += rim.k * rim.z_m, zz += rim.z_m * rim.z_m;
    }
    defined = places.size() >= 4;
    if (!defined) return;
    const std::int64_t determinant = n * kk - k * k;
    slope_m = (double(n) * kz - double(k) * z) / double(determinant);
    first_m = (z - slope_m * double(k)) / double(n);
    rms_m = std::sqrt(std::max((zz - first_m * z - slope_m * kz) / double(n), 0.0));
  }

  [[nodiscard]] bool good(double step_m) const {
    return defined && rms_m <= 0.1 && std::abs(slope_m) <= 0.546 * step_m;
  }
};

class Search {
 public:
  Search(const FusedColumns& map, const Ground& ground, const ColumnAt& column, const ColumnAt& vehicle)
      : ground_(ground),
        reach_(map.config.layers.search_distance),
        threshold_m_(map.config.layers.negative_threshold_m),
        line_(column, vehicle),
        step_m_(line_.step_m(map.config.map.resolution_xy_m)),
        range_m_(line_.length() * step_m_),
        lowest_rays_m_(map.lowest_ray_m),
        lowest_ray_m_(double{map.lowest_ray_m.at(column.x, column.y)}) {}

  // The larger difference that shows, or 0.
  double depth_m() {
    if (!find_rim() || mirrored_) return 0;
    std::vector<RimHeight> near;
    for (int k = 0; k <= 4; ++k) add_rims(near, k, rim_step_ + k);
    const Fit near_line(near);
    const double reached_m = near.back().k * step_m_;
    return std::max(hole_m(near_line), edge_m(near_line, reached_m));
  }

 private:
  bool find_rim() {
    for (int step = 1; step <= std::min(reach_, line_.length()); ++step)
      for (const ColumnAt& at : line_.abreast(step)) {
        if (ground_.rim.at(at.x, at.y) == YesNo::no) continue;
        rim_step_ = step;
        rim_m_ = double{ground_.known_m.at(at.x, at.y)};
        mirrored_ = rim_m_ - double{lowest_rays_m_.at(at.x, at.y)} > 0.3;
        return true;
      }
    return false;
  }

  void add_rims(std::vector<RimHeight>& rims, int k, int step) const {
    for (const ColumnAt& at : line_.abreast(step))
      if (ground_.rim.at(at.x, at.y) == YesNo::yes)
        rims.push_back({k, double{ground_.known_m.at(at.x, at.y)} - rim_m_});
  }

  [[nodiscard]] int first_ground_beyond() const {
    for (int step = 1; step <= reach_; ++step)
      for (const ColumnAt& at : line_.abreast(-step))
        if (ground_.known_m.at(at.x, at.y) < INFINITY) return step;
    return 0;
  }

  [[nodiscard]] double hole_m(const Fit& near) const {
    const int beyond = first_ground_beyond();
    if (beyond == 0) return 0;
    std::vector<RimHeight> rims;
    for (int k = 1; k <= 8; ++k) add_rims(rims, k, -(beyond + k));
    const Fit far(rims);
    if (!far.good(step_m_)) return 0;
    const double due_m = rim_m_ + far.first_m * rim_step_ / (rim_step_ + beyond);
    const double shows_m = 0.08 * threshold_m_ + 0.003 * range_m_ + (far.rms_m + near.rms_m);
    return due_m - lowest_ray_m_ > shows_m ? due_m - lowest_ray_m_ : 0;
  }

  [[nodiscard]] double edge_m(const Fit& near, double reached_m) const {
    if (rim_step_ > 2 * reach_ / 5 || !near.good(step_m_) || near.slope_m < -(0.35 * step_m_)) return 0;
    std::vector<RimHeight> rims;
    for (int k = 0; k <= 7; ++k) add_rims(rims, 5 + k, rim_step_ + 5 + k);
    const Fit earlier(rims);
    double away_m = -near.slope_m;
    const double bend_m = (-earlier.slope_m - away_m) - 0.4 * near.rms_m;
    if (earlier.defined && bend_m > 0) away_m = away_m - 8 * bend_m;
    const double due_m = rim_m_ + std::min(near.first_m, 0.0) + std::min(away_m, 0.0) * rim_step_;
    const double level_m = 0.34 * threshold_m_ + 0.004 * range_m_ + 2.5 * near.rms_m;
    const double carried_m = (0.05 + 0.01 * reached_m) * (rim_step_ * step_m_);
    return due_m - lowest_ray_m_ > std::max(level_m, carried_m) ? due_m - lowest_ray_m_ : 0;
  }

  const Ground& ground_;
  int reach_;
  double threshold_m_;
  SightLine line_;
  double step_m_, range_m_;
  const Columns<float>& lowest_rays_m_;
  double lowest_ray_m_;
  int rim_step_ = 0;
  double rim_m_ = 0;
  bool mirrored_ = false;
};

// Seen or assumed ground below the rims on both sides of it.
float pit_m(const FusedColumns& map, const Ground& ground, const ColumnAt& column) {
  constexpr int kSteps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  const double r = map.config.map.resolution_xy_m;
  float deepest_m = 0;
  for (int line = 0; line < 4; ++line)
    for (int d = 1; d <= 3; ++d) {
      const int dx = d * kSteps[line][0], dy = d * kSteps[line][1];
      const ColumnAt before{column.x - dx, column.y - dy}, after{column.x + dx, column.y + dy};
      if (ground.rim.at(before.x, before.y) == YesNo::no) continue;
      if (ground.rim.at(after.x, after.y) == YesNo::no) continue;
      const double bend_m = 0.08 * (((d * r) * (d * r)) * (line < 2 ? 1 : 2));
      const auto least_m = static_cast<float>(0.3 * map.config.layers.negative_threshold_m + bend_m);
      const float depth_m =
          std::min(ground.known_m.at(before.x, before.y), ground.known_m.at(after.x, after.y)) -
          ground.known_m.at(column.x, column.y);
      if (depth_m > least_m) deepest_m = std::max(deepest_m, depth_m);
    }
  return deepest_m;
}

float shown_m(const FusedColumns& map, const Ground& ground, const ColumnAt& column,
              const ColumnAt& vehicle) {
  if (ground.known_m.at(column.x, column.y) < INFINITY) return pit_m(map, ground, column);
  if (std::isinf(map.lowest_ray_m.at(column.x, column.y))) return 0;
  if (column.x == vehicle.x && column.y == vehicle.y) return 0;
  return static_cast<float>(Search(map, ground, column, vehicle).depth_m());
}

}  // namespace

void find_holes(const FusedColumns& map, const Ground& ground, const ColumnAt& vehicle, Layers& out) {
  Columns<YesNo> shows(out.n, YesNo::no);
  each_column(out.n, [&](int x, int y) {
    const float depth_m = shown_m(map, ground, {x, y}, vehicle);
    out.negative_delta[out.index(x, y)] = depth_m;
    if (depth_m > 0) shows.set(x, y, YesNo::yes);
  });
  each_column(out.n, [&](int x, int y) {
    if (shows.at(x, y) == YesNo::no) return;
    int neighbours = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if ((dx != 0 || dy != 0) && shows.at(x + dx, y + dy) == YesNo::yes) ++neighbours;
    const auto abreast = SightLine({x, y}, vehicle).abreast(0);
    const bool wide = shows.at(abreast[1].x, abreast[1].y) == YesNo::yes ||
                      shows.at(abreast[2].x, abreast[2].y) == YesNo::yes;
    if (neighbours >= 2 && wide) out.flags[out.index(x, y)] |= kNegative;
  });
}

}  // namespace gvom::oracle
