#include "tools/sim/ground_truth.hpp"

#include <algorithm>
#include <cmath>

#include "core/grid.hpp"
#include "tools/sim/parallel.hpp"
#include "tools/sim/truth_column.hpp"

namespace gvom::sim {
namespace {

constexpr double kAround = 52.0;      // truth beyond the path: half of the paper's grid
constexpr double kDropReach = 3.0;    // metres within which a hole's rim is
constexpr double kFaceReach = 1.0;    // metres within which a face rises
constexpr double kLethalStep = 0.5;   // metres
constexpr double kSlopeReach = 0.6;   // metres to both sides
constexpr double kSteepest = 0.48;    // radians
constexpr double kClearEnough = 2.0;  // metres
constexpr double kSample = 0.05;      // metres
constexpr double kWalkerStep = 0.02;  // seconds
constexpr float kUnbounded = std::numeric_limits<float>::infinity();

Area truth_area(const World& world) {
  const Area ground = world.terrain().area();
  Area area{1e18, 1e18, -1e18, -1e18};
  for (const Eigen::Vector2d& point : world.data().path_m) {
    area.min_x_m = std::min(area.min_x_m, point.x() - kAround);
    area.min_y_m = std::min(area.min_y_m, point.y() - kAround);
    area.max_x_m = std::max(area.max_x_m, point.x() + kAround);
    area.max_y_m = std::max(area.max_y_m, point.y() + kAround);
  }
  return {std::max(area.min_x_m, ground.min_x_m), std::max(area.min_y_m, ground.min_y_m),
          std::min(area.max_x_m, ground.max_x_m), std::min(area.max_y_m, ground.max_y_m)};
}

std::int64_t voxel_of(double value_m, double resolution_m) {
  return static_cast<std::int64_t>(std::floor(voxel_coordinate(value_m, resolution_m)));
}

GroundTruth empty_truth(const Area& area, double resolution_m) {
  GroundTruth truth{};
  truth.resolution_m = resolution_m;
  truth.origin[0] = voxel_of(area.min_x_m, resolution_m);
  truth.origin[1] = voxel_of(area.min_y_m, resolution_m);
  truth.size_x = static_cast<int>(voxel_of(area.max_x_m, resolution_m) - truth.origin[0]) + 1;
  truth.size_y = static_cast<int>(voxel_of(area.max_y_m, resolution_m) - truth.origin[1]) + 1;
  const std::size_t count = static_cast<std::size_t>(truth.size_x) * truth.size_y;
  for (std::vector<float>* layer :
       {&truth.ground_lowest, &truth.ground_mean, &truth.drop_m, &truth.clearance})
    layer->resize(count);
  for (std::vector<std::uint8_t>* layer : {&truth.classes, &truth.drivable, &truth.lethal, &truth.vegetation})
    layer->resize(count);
  truth.object.resize(count);
  return truth;
}

/// The columns of a truth, [y][x], and what they say of each other.
class Columns {
 public:
  Columns(const World& world, const GroundTruth& truth, int threads)
      : world_(world), truth_(truth), columns_(truth.classes.size()) {
    const double edge = truth.resolution_m;
    parallel_for(truth.size_y, threads, [&](int y) {
      for (int x = 0; x < truth.size_x; ++x)
        columns_[index(x, y)] = sample_column(world, static_cast<double>(truth.origin[0] + x) * edge,
                                              static_cast<double>(truth.origin[1] + y) * edge, edge);
    });
  }

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * truth_.size_x + x;
  }
  [[nodiscard]] const TruthColumn& at(int x, int y) const { return columns_[index(x, y)]; }

  /// Calls `visit` for the columns whose middle is no farther than `reach_m` from this one's.
  template <typename Visit>
  void around(int x, int y, double reach_m, const Visit& visit) const {
    const int reach = static_cast<int>(reach_m / truth_.resolution_m);
    const double limit = reach_m * reach_m / (truth_.resolution_m * truth_.resolution_m);
    for (int dy = std::max(-reach, -y); dy <= std::min(reach, truth_.size_y - 1 - y); ++dy)
      for (int dx = std::max(-reach, -x); dx <= std::min(reach, truth_.size_x - 1 - x); ++dx)
        if (dx * dx + dy * dy <= limit) visit(at(x + dx, y + dy));
  }

  [[nodiscard]] double drop_m(int x, int y) const {
    if (!at(x, y).is_hole) return 0.0;
    double highest = at(x, y).highest_m;
    around(x, y, kDropReach, [&](const TruthColumn& other) { highest = std::max(highest, other.highest_m); });
    return highest - at(x, y).lowest_m;
  }

  [[nodiscard]] bool is_high_face(int x, int y) const {
    if (!at(x, y).is_face) return false;
    double highest = at(x, y).highest_m, lowest = at(x, y).lowest_m;
    around(x, y, kFaceReach, [&](const TruthColumn& other) {
      highest = std::max(highest, other.highest_m);
      lowest = std::min(lowest, other.lowest_m);
    });
    return highest - lowest >= kLethalStep;
  }

  [[nodiscard]] bool is_drivable(int x, int y) const {
    bool all = slope_rad(x, y) < kSteepest;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, truth_.size_y - 1); ++ny)
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, truth_.size_x - 1); ++nx)
        all = all && is_open(at(nx, ny));
    return all;
  }

 private:
  static bool is_open(const TruthColumn& column) {
    if (column.is_blocked || column.is_hole || column.is_face) return false;
    switch (column.what) {
      case ObjectClass::ground:
      case ObjectClass::mirror:
      case ObjectClass::dark:
      case ObjectClass::grass:
        return true;
      case ObjectClass::overhang:
        return column.overhead_m - column.lowest_m >= kClearEnough;
      default:
        return false;
    }
  }

  [[nodiscard]] double slope_rad(int x, int y) const {
    const double middle_x = (static_cast<double>(truth_.origin[0] + x) + 0.5) * truth_.resolution_m;
    const double middle_y = (static_cast<double>(truth_.origin[1] + y) + 0.5) * truth_.resolution_m;
    const auto height = [&](double dx, double dy) {
      return world_.terrain().height_m(middle_x + dx, middle_y + dy);
    };
    const double along_x = (height(kSlopeReach, 0.0) - height(-kSlopeReach, 0.0)) / (2.0 * kSlopeReach);
    const double along_y = (height(0.0, kSlopeReach) - height(0.0, -kSlopeReach)) / (2.0 * kSlopeReach);
    return std::atan(std::hypot(along_x, along_y));
  }

  const World& world_;
  const GroundTruth& truth_;
  std::vector<TruthColumn> columns_;
};

/// Marks the columns that a walker's body covers at some time.
void mark_walkers(const World& world, const TruthOptions& options, GroundTruth& truth) {
  for (double time = 0.0; time <= options.seconds; time += kWalkerStep)
    for (const Primitive& body : world.walkers_at(time))
      for (double y = body.lower.y(); y <= body.upper.y(); y += kSample)
        for (double x = body.lower.x(); x <= body.upper.x(); x += kSample) {
          if (intersect(body, {{x, y, 0.0}, Eigen::Vector3d::UnitZ()}).empty()) continue;
          const std::int64_t ix = voxel_of(x, truth.resolution_m) - truth.origin[0];
          const std::int64_t iy = voxel_of(y, truth.resolution_m) - truth.origin[1];
          if (ix < 0 || iy < 0 || ix >= truth.size_x || iy >= truth.size_y) continue;
          truth.classes[iy * truth.size_x + ix] = static_cast<std::uint8_t>(ObjectClass::person);
          truth.object[iy * truth.size_x + ix] = body.object;
        }
}

}  // namespace

GroundTruth sample_truth(const World& world, const TruthOptions& options) {
  GroundTruth truth = empty_truth(truth_area(world), options.resolution_m);
  const Columns columns(world, truth, options.threads);
  parallel_for(truth.size_y, options.threads, [&](int y) {
    for (int x = 0; x < truth.size_x; ++x) {
      const TruthColumn& column = columns.at(x, y);
      const std::size_t at = columns.index(x, y);
      const double drop = columns.drop_m(x, y);
      truth.ground_lowest[at] = static_cast<float>(column.lowest_m);
      truth.ground_mean[at] = static_cast<float>(column.mean_m);
      truth.drop_m[at] = static_cast<float>(drop);
      truth.clearance[at] =
          column.overhead_object >= 0 ? static_cast<float>(column.overhead_m - column.lowest_m) : kUnbounded;
      truth.classes[at] = static_cast<std::uint8_t>(column.what);
      truth.object[at] = column.object;
      truth.drivable[at] = columns.is_drivable(x, y);
      truth.lethal[at] = column.is_lethal || drop >= kLethalStep || columns.is_high_face(x, y);
      truth.vegetation[at] = column.is_vegetation;
    }
  });
  mark_walkers(world, options, truth);
  return truth;
}

}  // namespace gvom::sim
