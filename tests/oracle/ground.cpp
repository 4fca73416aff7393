#include "tests/oracle/ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace gvom::oracle {

namespace {

constexpr float kUnknown_m = std::numeric_limits<float>::infinity();

struct Line {
  int dx, dy;
  double stretch;  // the square of its steps' length, columns^2
};
constexpr Line kFourLines[] = {{1, 0, 1}, {0, 1, 1}, {1, 1, 2}, {1, -1, 2}};

// 1: the plane that the vehicle stands on, within its radius.
float assumed_ground_m(const FusedColumns& map, int x, int y) {
  const MapperConfig& config = map.config;
  const Eigen::Vector3d& vehicle_m = map.newest.T_odom_base.translation_m;
  const Eigen::Quaterniond& q = map.newest.T_odom_base.rotation;
  const double edge_m = config.map.resolution_xy_m;
  const double dx_m = (map.newest.grid.origin[0] + x + 0.5) * edge_m - vehicle_m.x();
  const double dy_m = (map.newest.grid.origin[1] + y + 0.5) * edge_m - vehicle_m.y();
  if (std::sqrt(dx_m * dx_m + dy_m * dy_m) > config.vehicle.radius_m) return kUnknown_m;
  const double up_x = 2 * q.z() * q.x() + 2 * q.y() * q.w();
  const double up_y = 2 * q.z() * q.y() - 2 * q.x() * q.w();
  const double up_z = 1 - (2 * q.x() * q.x() + 2 * q.y() * q.y());
  const double inverse = up_z > 0.5 ? 1 / up_z : 0;
  const double rise_m = -up_x * inverse * dx_m + -up_y * inverse * dy_m;
  return static_cast<float>(vehicle_m.z() - config.vehicle.base_height_m + rise_m);
}

// 2.
bool hangs(const ColumnVoxels& column, int lowest, float lowest_m, float lowest_ray_m) {
  if (lowest_m - lowest_ray_m <= 0.3f) return false;
  for (int z = 0; z < lowest; ++z)
    if (column.free(z) && column.at(z).passes >= column.at(lowest).hits) return true;
  return false;
}

// 1 to 3.
void read_column(const FusedColumns& map, int x, int y, Ground& ground) {
  const ColumnVoxels column = map.column(x, y);
  const int lowest = map.ground(x, y);
  if (lowest < 0) {
    const float assumed_m = assumed_ground_m(map, x, y);
    ground.known_m.set(x, y, assumed_m);
    if (assumed_m < kUnknown_m) ground.assumed.set(x, y, YesNo::yes);
    return;
  }
  const float lowest_m = map.lowest_return_m(x, y);
  const float ray_m = map.lowest_ray_m.at(x, y);
  ground.lowest_m.set(x, y, lowest_m);
  if (hangs(column, lowest, lowest_m, ray_m)) return;
  const float over_ray_m = lowest_m - ray_m;
  ground.known_m.set(x, y, over_ray_m > 0.1f && over_ray_m <= 0.3f ? ray_m : lowest_m);
}

// 4.
bool stands_out(const Columns<float>& known_m, int x, int y, double edge_m) {
  const float here_m = known_m.at(x, y);
  if (here_m == kUnknown_m) return false;
  for (const Line& line : kFourLines)
    for (int d = 1; d <= 8; ++d) {
      const float before_m = known_m.at(x - d * line.dx, y - d * line.dy);
      const float after_m = known_m.at(x + d * line.dx, y + d * line.dy);
      if (before_m == kUnknown_m || after_m == kUnknown_m) continue;
      const double bends_m = 0.1 + 0.08 * (d * edge_m * (d * edge_m) * line.stretch);
      if (here_m > std::max(before_m, after_m) + static_cast<float>(bends_m)) return true;
    }
  return false;
}

// 5, of ground that does not stand out.
bool is_rim(const Columns<float>& known_m, int x, int y, double edge_m) {
  if (known_m.at(x, y) == kUnknown_m) return false;
  for (int dy = -6; dy <= 6; ++dy)
    for (int dx = -6; dx <= 6; ++dx) {
      const auto rise_x_m = static_cast<float>(0.6 * (std::abs(dx) * edge_m));
      const auto rise_y_m = static_cast<float>(0.6 * (std::abs(dy) * edge_m));
      if (known_m.at(x, y) > known_m.at(x + dx, y + dy) + rise_x_m + rise_y_m + 0.1f) return false;
    }
  return true;
}

// Columns to the nearest rim of 8.
std::optional<int> way_to_rim(const Columns<YesNo>& rim, int x, int y, int dx, int dy) {
  for (int d = 1; d <= 8; ++d)
    if (rim.at(x + d * dx, y + d * dy) == YesNo::yes) return d;
  return std::nullopt;
}

// 6.
float between_rims_m(const Ground& ground, int x, int y) {
  double weights = 0, heights = 0;
  for (const Line& line : kFourLines) {
    const auto before = way_to_rim(ground.rim, x, y, -line.dx, -line.dy);
    const auto after = way_to_rim(ground.rim, x, y, line.dx, line.dy);
    if (!before || !after) continue;
    const double before_m{ground.known_m.at(x - *before * line.dx, y - *before * line.dy)};
    const double after_m{ground.known_m.at(x + *after * line.dx, y + *after * line.dy)};
    const double apart = *before + *after;
    const double weight = 1 / (apart * apart * line.stretch);
    weights += weight;
    heights += weight * ((before_m * *after + after_m * *before) / apart);
  }
  return weights == 0 ? kUnknown_m : static_cast<float>(heights / weights);
}

}  // namespace

Ground::Ground(int n)
    : lowest_m(n, kUnknown_m),
      known_m(n, kUnknown_m),
      height_m(n, kUnknown_m),
      assumed(n, YesNo::no),
      rim(n, YesNo::no) {}

Ground find_ground(const FusedColumns& map) {
  const int n = map.config.map.size_xy;
  const double edge_m = map.config.map.resolution_xy_m;
  Ground ground(n);
  Columns<YesNo> outstanding(n, YesNo::no);
  each_column(n, [&](int x, int y) { read_column(map, x, y, ground); });
  each_column(n, [&](int x, int y) {
    if (stands_out(ground.known_m, x, y, edge_m))
      outstanding.set(x, y, YesNo::yes);
    else if (is_rim(ground.known_m, x, y, edge_m))
      ground.rim.set(x, y, YesNo::yes);
  });
  each_column(n, [&](int x, int y) {
    const float known_m = ground.known_m.at(x, y), lowest_m = ground.lowest_m.at(x, y);
    const bool hidden = known_m == kUnknown_m && lowest_m < kUnknown_m;
    ground.height_m.set(x, y, known_m);
    if (!hidden && outstanding.at(x, y) == YesNo::no) return;
    const float between_m = between_rims_m(ground, x, y);
    if (between_m < kUnknown_m) ground.height_m.set(x, y, std::min(between_m, hidden ? lowest_m : known_m));
  });
  return ground;
}

}  // namespace gvom::oracle
