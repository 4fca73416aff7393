// What it costs to drive over each cell of the map, and where the vehicle fits.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "services/common/planner_config.hpp"
#include "services/planner/distance.hpp"
#include "services/planner/map_view.hpp"

namespace gvom::planner {

inline constexpr float kLethalCost = std::numeric_limits<float>::infinity();

/// A cost per metre and how it changes with x and y.
struct CostSample {
  double cost = 0;
  Eigen::Vector2d gradient{0, 0};  ///< Per metre.
};

/// The weighted sum of the layers (the paper's section on tests), grown around what is lethal and, falling
/// off to the sides, around what is SOFT: they meet a bush, too, and a rock little higher than the clearance
/// is as often SOFT as HARD. Made anew for each map, without allocating.
class Costmap {
 public:
  /// @param n_xy the largest map, columns along an edge
  Costmap(const CostmapConfig& config, const VehicleLimits& vehicle, int n_xy);

  void update(const MapView& map);

  [[nodiscard]] const Cells& cells() const { return cells_; }
  /// Of base_link at the cell's middle, per metre, at least 1; kLethalCost where the vehicle hits something
  /// whatever its heading.
  [[nodiscard]] const float* cost() const { return cost_.data(); }
  /// 1: the column itself is lethal. HARD, or too low to pass below; STEEP or NEGATIVE unless it is the only
  /// lethal one of the 3 x 3 around it.
  [[nodiscard]] const std::uint8_t* lethal() const { return lethal_.data(); }
  /// 1: its ground is seen, remembered or assumed, or lies in a gap between such.
  [[nodiscard]] const std::uint8_t* known() const { return known_.data(); }
  /// From the cell's middle to the nearest lethal cell's middle, metres; large where there is none.
  [[nodiscard]] const float* distance_m() const { return distance_m_.data(); }

  /// Bilinear between the cells' middles, finite. Where `cost` is lethal it is half of `kMostCost` at the
  /// edge and rises to all of it on the lethal cell, so that a descent finds its way out. Beyond the
  /// outermost middles it is as on them.
  [[nodiscard]] double smooth_cost(double x_m, double y_m) const { return sample(x_m, y_m).cost; }
  [[nodiscard]] CostSample sample(double x_m, double y_m) const;
  /// Whether the rectangle of the vehicle and its margin, at this pose, is free of what is lethal: the middle
  /// of no lethal cell lies in the rectangle that is `margin_m` larger on each side. So the vehicle itself
  /// keeps off what stands in a cell by the margin less half a cell. What is outside of the map is free.
  [[nodiscard]] bool fits(const Pose2& pose) const;
  static constexpr double kMostCost = 100;

  [[nodiscard]] double vehicle_length_m() const { return vehicle_.length_m(); }

 private:
  void find_lethal(const MapView& map);
  void find_soft(const MapView& map);
  void find_known(const MapView& map);
  /// Ground counts as seen where `gap` columns without it, one (dx, dy) after the other, lie between two
  /// with.
  void bridge(int dx, int dy, int gap, double rise_m);
  void weigh(const MapView& map);
  [[nodiscard]] bool holds_lethal(const Eigen::Vector2d& middle, const Eigen::Vector2d& forward) const;

  CostmapConfig config_;
  VehicleLimits vehicle_;
  double half_length_m_;  ///< Of the vehicle and its margin.
  double half_width_m_;
  Cells cells_;
  std::vector<float> cost_;
  std::vector<float> smooth_;
  std::vector<float> distance_m_;
  std::vector<float> soft_m_;    ///< From the cell's middle to the nearest SOFT cell's.
  std::vector<float> ground_m_;  ///< Its height; NaN: not known.
  std::vector<std::uint8_t> lethal_;
  std::vector<std::uint8_t> known_;
  std::vector<std::uint8_t> soft_;      ///< 1: SOFT.
  std::vector<std::uint8_t> open_;      ///< 1: without ground, and no hole.
  std::vector<std::uint8_t> marked_;    ///< 1: flagged as lethal; with one cell more on each side.
  std::vector<std::uint8_t> bridging_;  ///< Of one row.
  DistanceTransform transform_;
};

}  // namespace gvom::planner
