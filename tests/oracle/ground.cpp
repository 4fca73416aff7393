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

float rise_m(int columns, double edge_m) {
  return static_cast<float>(0.6 * (std::abs(columns) * edge_m));
}

// 5 and 6: whether known ground is higher by this much than some ground around would let it be.
bool is_over_cones(const Columns<float>& known_m, int x, int y, double edge_m, float by_m) {
  for (int dy = -6; dy <= 6; ++dy)
    for (int dx = -6; dx <= 6; ++dx) {
      const float cone_m = known_m.at(x + dx, y + dy) + rise_m(dx, edge_m) + rise_m(dy, edge_m);
      if (known_m.at(x, y) > cone_m + by_m) return true;
    }
  return false;
}

// 5, of known ground.
bool is_rough(const Columns<float>& known_m, const Columns<YesNo>& perhaps_rim, int x, int y) {
  int rims = 0, others = 0;
  for (int dy = -6; dy <= 6; ++dy)
    for (int dx = -6; dx <= 6; ++dx) {
      const bool known = known_m.at(x + dx, y + dy) != kUnknown_m;
      if (known && perhaps_rim.at(x + dx, y + dy) == YesNo::yes)
        ++rims;
      else if (known)
        ++others;
    }
  return 4 * rims < others;
}

// Columns to the nearest rim of 8.
std::optional<int> way_to_rim(const Columns<YesNo>& rim, int x, int y, int dx, int dy) {
  for (int d = 1; d <= 8; ++d)
    if (rim.at(x + d * dx, y + d * dy) == YesNo::yes) return d;
  return std::nullopt;
}

// 6.
bool is_carried(const Ground& ground, int x, int y, double edge_m) {
  for (const Line& line : kFourLines)
    for (const int way : {1, -1}) {
      const int dx = way * line.dx, dy = way * line.dy;
      const auto d = way_to_rim(ground.rim, x, y, dx, dy);
      if (!d) continue;
      float reach_m = ground.known_m.at(x + *d * dx, y + *d * dy) + rise_m(*d, edge_m);
      if (line.stretch == 2) reach_m += rise_m(*d, edge_m);
      if (ground.known_m.at(x, y) <= reach_m + 0.1f) return true;
    }
  return false;
}

// 6: of a line; nothing where it is not known.
std::optional<float> bend_m(const Columns<float>& known_m, int x, int y, const Line& line) {
  const auto known = [&](int d) { return known_m.at(x + d * line.dx, y + d * line.dy); };
  const bool before = known(-1) < kUnknown_m, after = known(1) < kUnknown_m;
  if (!before && !after) return std::nullopt;
  const int middle = before && after ? 0 : after ? 1 : -1;
  const float one_m = known(middle - 1), other_m = known(middle + 1);
  if (one_m == kUnknown_m || other_m == kUnknown_m) return std::nullopt;
  return std::abs(one_m + other_m - 2 * known(middle));
}

// 6.
bool is_face(const Columns<float>& known_m, int x, int y) {
  int even = 0;
  for (const Line& line : kFourLines)
    if (const auto bend = bend_m(known_m, x, y, line)) {
      if (*bend > 1) return false;
      ++even;
    }
  return even >= 3;
}

// 7.
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

struct Standing {
  explicit Standing(int n) : out(n, YesNo::no), doubtful(n, YesNo::no) {}
  Columns<YesNo> out, doubtful;
};

// 4 to 6: rims, and what stands out or is doubtful.
void find_rims(Ground& ground, double edge_m, Standing& standing) {
  const int n = ground.known_m.n();
  Columns<YesNo> perhaps_rim(n, YesNo::no);
  each_column(n, [&](int x, int y) {
    if (ground.known_m.at(x, y) == kUnknown_m) return;
    if (is_over_cones(ground.known_m, x, y, edge_m, 1.2f)) standing.doubtful.set(x, y, YesNo::yes);
    if (stands_out(ground.known_m, x, y, edge_m))
      standing.out.set(x, y, YesNo::yes);
    else if (!is_over_cones(ground.known_m, x, y, edge_m, 0.1f))
      perhaps_rim.set(x, y, YesNo::yes);
  });
  each_column(n, [&](int x, int y) {
    if (ground.known_m.at(x, y) == kUnknown_m) return;
    if (is_rough(ground.known_m, perhaps_rim, x, y))
      standing.doubtful.set(x, y, YesNo::yes);
    else
      ground.rim.set(x, y, perhaps_rim.at(x, y));
  });
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
  each_column(n, [&](int x, int y) { read_column(map, x, y, ground); });
  Standing standing(n);
  find_rims(ground, edge_m, standing);
  each_column(n, [&](int x, int y) {
    const float known_m = ground.known_m.at(x, y), lowest_m = ground.lowest_m.at(x, y);
    const bool seen = known_m < kUnknown_m && ground.assumed.at(x, y) == YesNo::no;
    const bool foliage = seen && standing.doubtful.at(x, y) == YesNo::yes &&
                         !is_carried(ground, x, y, edge_m) && !is_face(ground.known_m, x, y);
    const bool hidden = known_m == kUnknown_m && lowest_m < kUnknown_m;
    ground.height_m.set(x, y, known_m);
    if (!hidden && !foliage && standing.out.at(x, y) == YesNo::no) return;
    const float between_m = between_rims_m(ground, x, y);
    if (between_m < kUnknown_m)
      ground.height_m.set(x, y, std::min(between_m, hidden ? lowest_m : known_m));
    else if (foliage)
      ground.height_m.set(x, y, kUnknown_m);
  });
  return ground;
}

}  // namespace gvom::oracle
