#include "tools/evaluation/holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::evaluation {
namespace {

using sim::GroundMap;
using sim::Surface;

constexpr double kBeyondEnd_m = 6.0;  // of the path
constexpr double kHalfWay_m = 1.0;    // of the width of a lane
constexpr double kMiddle_m = 0.5;     // half of a lane's middle metre
constexpr double kOutermostLane_m = 4.0;
constexpr double kBesideRim_m = 0.5;

struct Node {
  int x;
  int y;
};

class Nodes {
 public:
  explicit Nodes(const GroundMap& ground) : ground_(ground), taken_(ground.surface.size(), 0) {}

  [[nodiscard]] Node nearest(const Eigen::Vector2d& point_m) const {
    return {static_cast<int>(std::lround((point_m.x() - ground_.min_x_m) / ground_.resolution_m)),
            static_cast<int>(std::lround((point_m.y() - ground_.min_y_m) / ground_.resolution_m))};
  }
  [[nodiscard]] bool contains(const Node& n) const {
    return n.x >= 0 && n.y >= 0 && n.x < ground_.nodes_x && n.y < ground_.nodes_y;
  }
  [[nodiscard]] std::size_t at(const Node& n) const {
    return static_cast<std::size_t>(n.y) * ground_.nodes_x + n.x;
  }
  [[nodiscard]] Eigen::Vector2d place_m(const Node& n) const {
    return {ground_.min_x_m + n.x * ground_.resolution_m, ground_.min_y_m + n.y * ground_.resolution_m};
  }
  [[nodiscard]] double height_m(const Node& n) const { return ground_.height_m[at(n)]; }
  [[nodiscard]] bool is_new_hole(const Node& n) const {
    return contains(n) && ground_.surface[at(n)] == Surface::hole && !taken_[at(n)];
  }

  /// All nodes of hole or face that hang together with this one; they are not new any more.
  std::vector<Node> take(const Node& first) {
    std::vector<Node> found{first};
    taken_[at(first)] = 1;
    for (std::size_t i = 0; i < found.size(); ++i)
      for (int k = 0; k < 9; ++k) {
        const Node next{found[i].x + k % 3 - 1, found[i].y + k / 3 - 1};
        if (!contains(next) || taken_[at(next)]) continue;
        const Surface surface = ground_.surface[at(next)];
        if (surface != Surface::hole && surface != Surface::face) continue;
        taken_[at(next)] = 1;
        found.push_back(next);
      }
    return found;
  }

 private:
  const GroundMap& ground_;
  std::vector<char> taken_;
};

Eigen::Vector2d direction_at(const std::vector<Eigen::Vector2d>& path_m, std::size_t i) {
  const std::size_t from = std::min(i, path_m.size() - 2);
  return (path_m[from + 1] - path_m[from]).normalized();
}

/// The path, and straight on beyond its end.
std::vector<Eigen::Vector2d> lengthen(std::vector<Eigen::Vector2d> path_m) {
  const Eigen::Vector2d end = path_m.back();
  const Eigen::Vector2d forward = direction_at(path_m, path_m.size() - 1);
  for (double way_m = kPathStep_m; way_m < kBeyondEnd_m; way_m += kPathStep_m)
    path_m.push_back(end + way_m * forward);
  return path_m;
}

/// Where a hole begins and ends along a strip, seen from where the path met it; what belongs to it further
/// off (a bend of a ditch) does not count. Begins after it ends where the hole is not in the strip.
struct Extent {
  double from_m = std::numeric_limits<double>::infinity();
  double to_m = -std::numeric_limits<double>::infinity();
};
Extent extent_of(const std::vector<Eigen::Vector2d>& along, double offset_m, double half_width_m,
                 double node_m) {
  Extent extent;
  for (const Eigen::Vector2d& at : along) {
    if (std::abs(at.y() - offset_m) > half_width_m || std::abs(at.x()) > 2.0 * kWidestHole_m) continue;
    extent.from_m = std::min(extent.from_m, at.x() - 0.5 * node_m);
    extent.to_m = std::max(extent.to_m, at.x() + 0.5 * node_m);
  }
  return extent;
}

void add_lane(Hole& hole, const std::vector<Eigen::Vector2d>& along, double offset_m, double node_m) {
  const Extent extent = extent_of(along, offset_m, kMiddle_m, node_m);
  if (extent.from_m > extent.to_m) return;
  hole.open = hole.open || extent.to_m - extent.from_m > kWidestHole_m;
  hole.lanes.push_back({offset_m, extent.from_m, std::min(extent.to_m, extent.from_m + kWidestHole_m)});
}

/// The lane nearest to the path's middle; there is one.
const Lane& middle_lane(const Hole& hole) {
  return *std::min_element(hole.lanes.begin(), hole.lanes.end(), [](const Lane& a, const Lane& b) {
    return std::abs(a.offset_m) < std::abs(b.offset_m);
  });
}

/// Width, and whether there is a far side, along the middle line of that lane: an oblique ditch is wider
/// across a whole lane.
void measure_width(Hole& hole, const Nodes& nodes, const std::vector<Eigen::Vector2d>& along, double before_m,
                   double node_m) {
  const Lane& lane = middle_lane(hole);
  const Extent narrow = extent_of(along, lane.offset_m, node_m, node_m);
  const Extent extent = narrow.from_m < narrow.to_m ? narrow : Extent{lane.rim_m, lane.far_rim_m};
  hole.width_m = std::min(extent.to_m - extent.from_m, kWidestHole_m);
  const Eigen::Vector2d left(-hole.forward.y(), hole.forward.x());
  const Node beyond =
      nodes.nearest(hole.rim_point_m + (extent.to_m + kBesideRim_m) * hole.forward + lane.offset_m * left);
  if (nodes.contains(beyond) && nodes.height_m(beyond) < before_m - 0.5 * hole.depth_m) hole.open = true;
}

void measure(Hole& hole, const Nodes& nodes, const std::vector<Node>& members, double node_m) {
  const Eigen::Vector2d left(-hole.forward.y(), hole.forward.x());
  std::vector<Eigen::Vector2d> along;
  double lowest_m = std::numeric_limits<double>::infinity();
  double rim_m = 0.0;
  for (const Node& member : members) {
    const Eigen::Vector2d way = nodes.place_m(member) - hole.rim_point_m;
    along.emplace_back(way.dot(hole.forward), way.dot(left));
    if (std::abs(along.back().y()) > kHalfWay_m || std::abs(along.back().x()) > kWidestHole_m) continue;
    lowest_m = std::min(lowest_m, nodes.height_m(member));
    rim_m = std::min(rim_m, along.back().x() - 0.5 * node_m);
  }
  hole.rim_driven_m += rim_m;
  for (double offset_m = -kOutermostLane_m; offset_m <= kOutermostLane_m; offset_m += 1.0)
    add_lane(hole, along, offset_m, node_m);
  const Node before = nodes.nearest(hole.rim_point_m + (rim_m - kBesideRim_m) * hole.forward);
  if (hole.lanes.empty() || !nodes.contains(before)) return;
  hole.depth_m = nodes.height_m(before) - lowest_m;
  measure_width(hole, nodes, along, nodes.height_m(before), node_m);
}

}  // namespace

std::vector<Hole> find_holes(const GroundMap& ground, const std::vector<Eigen::Vector2d>& path_m) {
  std::vector<Hole> holes;
  if (path_m.size() < 2) return holes;
  Nodes nodes(ground);
  const std::vector<Eigen::Vector2d> way = lengthen(path_m);
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Eigen::Vector2d forward = direction_at(way, i);
    const Eigen::Vector2d left(-forward.y(), forward.x());
    for (double offset_m = -kHalfWay_m; offset_m <= kHalfWay_m; offset_m += ground.resolution_m) {
      const Node node = nodes.nearest(way[i] + offset_m * left);
      if (!nodes.is_new_hole(node)) continue;
      Hole hole;
      hole.rim_point_m = way[i];
      hole.forward = forward;
      hole.rim_driven_m = static_cast<double>(i) * kPathStep_m;
      measure(hole, nodes, nodes.take(node), ground.resolution_m);
      if (hole.depth_m >= kShallowestHole_m && !hole.lanes.empty()) holes.push_back(hole);
    }
  }
  return holes;
}

double range_allowed_m(double width_m, double height_m, double beam_spacing_rad) {
  return std::sqrt(width_m * height_m / beam_spacing_rad);
}

double barred_from_m(std::vector<Approach> approaches) {
  if (approaches.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(approaches.begin(), approaches.end(),
            [](const Approach& a, const Approach& b) { return a.distance_m < b.distance_m; });
  double from_m = 0.0;
  for (const Approach& approach : approaches) {
    if (!approach.barred) break;
    from_m = approach.distance_m;
  }
  return from_m;
}

}  // namespace gvom::evaluation
