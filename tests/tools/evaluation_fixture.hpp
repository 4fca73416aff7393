// A small world whose truth is written by hand, and maps of it: perfect ones, to be spoilt by the tests.
#pragma once

#include <limits>
#include <vector>

#include "tools/evaluation/judge.hpp"

namespace gvom::test {

using evaluation::ObjectClass;

/// Flat ground at 0 m, 120 x 60 columns of 0.4 m from (-4, -12) m on. The path goes along y = 0 from x = 0 to
/// 40 m.
class HandMadeScene {
 public:
  static constexpr int kColumnsX = 120;
  static constexpr int kColumnsY = 60;
  static constexpr double kEdge_m = 0.4;

  HandMadeScene() {
    const std::size_t count = kColumnsX * kColumnsY;
    truth.resolution_m = kEdge_m;
    truth.origin[0] = -10;
    truth.origin[1] = -30;
    truth.size_x = kColumnsX;
    truth.size_y = kColumnsY;
    truth.ground_lowest.assign(count, 0.0F);
    truth.ground_mean.assign(count, 0.0F);
    truth.drop_m.assign(count, 0.0F);
    truth.clearance.assign(count, std::numeric_limits<float>::infinity());
    truth.classes.assign(count, 0);
    truth.object.assign(count, -1);
    truth.drivable.assign(count, 1);
    truth.lethal.assign(count, 0);
    truth.vegetation.assign(count, 0);
    sim::GroundMap& ground = world.ground;
    ground.min_x_m = -4.0;
    ground.min_y_m = -12.0;
    ground.nodes_x = 481;
    ground.nodes_y = 241;
    ground.height_m.assign(std::size_t{481} * 241, 0.0F);
    ground.surface.assign(std::size_t{481} * 241, sim::Surface::ground);
  }

  /// A rectangle of the ground becomes a hole, in nodes and columns whose middle lies in it.
  void dig(double min_x_m, double max_x_m, double min_y_m, double max_y_m, double depth_m) {
    sim::GroundMap& ground = world.ground;
    for (int y = 0; y < ground.nodes_y; ++y)
      for (int x = 0; x < ground.nodes_x; ++x) {
        const double x_m = ground.min_x_m + 0.1 * x, y_m = ground.min_y_m + 0.1 * y;
        if (x_m < min_x_m || x_m > max_x_m || y_m < min_y_m || y_m > max_y_m) continue;
        const std::size_t at = static_cast<std::size_t>(y) * ground.nodes_x + x;
        ground.surface[at] = sim::Surface::hole;
        ground.height_m[at] = static_cast<float>(-depth_m);
      }
    for (std::size_t column = 0; column < truth.classes.size(); ++column) {
      const Eigen::Vector2d middle_m = evaluation::middle_of(truth, column);
      if (middle_m.x() < min_x_m || middle_m.x() > max_x_m) continue;
      if (middle_m.y() < min_y_m || middle_m.y() > max_y_m) continue;
      put(column, ObjectClass::ditch, -1);
      truth.drop_m[column] = static_cast<float>(depth_m);
      truth.ground_lowest[column] = static_cast<float>(-depth_m);
      truth.lethal[column] = 1;
    }
  }

  void put(std::size_t column, ObjectClass what, int object) {
    truth.classes[column] = static_cast<std::uint8_t>(what);
    truth.object[column] = object;
    truth.drivable[column] = 0;
  }

  /// Returns its number.
  int plant(sim::Kind kind, double x_m, double y_m, double radius_m, double height_m) {
    sim::Object object;
    object.kind = kind;
    object.position_m = {x_m, y_m, 0.0};
    object.radius_m = radius_m;
    object.height_m = height_m;
    world.objects.push_back(object);
    return static_cast<int>(world.objects.size()) - 1;
  }

  [[nodiscard]] std::size_t column(double x_m, double y_m) const {
    return static_cast<std::size_t>(evaluation::column_at(truth, {x_m, y_m}));
  }

  [[nodiscard]] evaluation::SceneFacts facts() const {
    std::vector<Eigen::Vector2d> path_m;
    for (int i = 0; i <= 400; ++i) path_m.emplace_back(0.1 * i, 0.0);
    return evaluation::find_facts(world, truth, path_m);
  }

  sim::WorldData world;
  evaluation::Truth truth{};
};

/// A map on the truth's own grid, which is made square: all ground seen, nothing flagged.
class HandMadeMap {
 public:
  explicit HandMadeMap(const evaluation::Truth& truth) : truth_(truth) {
    const std::size_t count = static_cast<std::size_t>(kSize) * kSize;
    height.assign(count, 0.0F);
    flags.assign(count, 0);
    visibility.assign(count, static_cast<std::uint8_t>(Visibility::ground_seen));
    for (std::size_t column = 0; column < truth.classes.size(); ++column)
      height[at(column)] = truth.ground_lowest[column];
  }

  /// Where a column of the truth lies in the map.
  [[nodiscard]] std::size_t at(std::size_t column) const {
    return column / truth_.size_x * kSize + column % truth_.size_x;
  }

  /// Valid while this lives; the vehicle at (driven_m, 0), looking along x.
  [[nodiscard]] evaluation::Frame frame(double driven_m, double time_s = 0.0) const {
    evaluation::Frame frame;
    frame.time_s = time_s;
    frame.driven_m = driven_m;
    frame.base_m = {driven_m, 0.0};
    frame.sensor_m = {driven_m, 0.0, 1.7};
    frame.origin = {truth_.origin[0], truth_.origin[1]};
    frame.size = kSize;
    frame.height = height.data();
    frame.flags = flags.data();
    frame.visibility = visibility.data();
    return frame;
  }

  std::vector<float> height;
  std::vector<std::uint8_t> flags, visibility;

 private:
  static constexpr int kSize = 128;
  const evaluation::Truth& truth_;
};

/// Nothing is hidden; what a ray is aimed at is where it ends, or for points just above the ground nowhere.
inline double open_sight(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  return to_m.z() < 0.1 ? std::numeric_limits<double>::infinity() : (to_m - from_m).norm();
}

inline evaluation::Figures judge(const evaluation::SceneFacts& facts,
                                 const std::vector<evaluation::Frame>& frames) {
  evaluation::Judge judge(facts, {1.7, 0.0125}, open_sight);
  for (const evaluation::Frame& frame : frames) judge.add(frame);
  return judge.result();
}

}  // namespace gvom::test
