// The way over the costmap to a goal: A*, 8-connected.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "services/planner/bucket_queue.hpp"
#include "services/planner/costmap.hpp"

namespace gvom::planner {

enum class SearchResult {
  found,   ///< A way to the goal, or to the border where the goal is beyond the map.
  cut,     ///< The budget was spent: the way to what came nearest to the vehicle; not all of it is searched.
  no_way,  ///< All that the goal can be reached from is searched, and the vehicle is not there.
  goal_in_obstacle,     ///< And no free cell is near enough to it.
  vehicle_in_obstacle,  ///< It stands where nothing fits, and no way leads there.
};

/// Searches backwards, from the goal to the vehicle, so that what any place around the vehicle still costs is
/// known: that is what trajectories are judged by. A goal beyond the map is reached from each cell of its
/// border, at the straight distance times `kBeyond`; one in an obstacle, at the nearest free cell within
/// `kGoalSlack_m`. An edge costs its length times the mean of its cells' costs. Cells that cost kLethalCost
/// are no way, but within half the vehicle's length of it they cost Costmap::kMostCost: it can leave what it
/// stands too near to. No edge passes between two cells that are no way.
class Search {
 public:
  static constexpr double kBeyond = 1.3;  ///< What a metre costs that no map knows.
  static constexpr double kGoalSlack_m = 3;

  explicit Search(int n_xy);

  /// @param around_m all places so near to the vehicle, that it can reach without going farther off, are
  /// searched, too, if the budget lasts
  /// @param budget cells that are looked at, at most
  SearchResult run(const Costmap& map, const Eigen::Vector2d& vehicle_m, const Eigen::Vector2d& goal_m,
                   double around_m, int budget);

  /// What is left to pay from the middle of a cell to the goal; +infinity: not reached.
  [[nodiscard]] const float* cost_to_go() const { return cost_to_go_.data(); }
  /// From the vehicle's cell on to the goal or the border, middles of cells in odom; where it was cut, the
  /// first piece is a straight line that nobody searched. Valid until the next run.
  [[nodiscard]] const std::vector<Eigen::Vector2d>& path() const { return path_; }

 private:
  /// A cell of the map, or of the ring around it that is no way.
  struct Node {
    float cost;           ///< To go.
    float half_edge;      ///< This cell's share of an edge of one cell's length.
    float ahead;          ///< At least what is to pay from here to the vehicle: the length of eight ways.
    std::int32_t wanted;  ///< 1: the search goes on till this one is reached.
  };

  void prepare(const Costmap& map, const Eigen::Vector2d& vehicle_m, double around_m);
  void open_around_vehicle(const Costmap& map);
  void want_around_vehicle(double around_m);
  /// False: there is no free cell to begin from.
  bool seed(const Costmap& map, const Eigen::Vector2d& goal_m);
  void seed_border(const Eigen::Vector2d& goal_m);
  [[nodiscard]] std::int32_t free_cell_near(const Costmap& map, const Eigen::Vector2d& goal_m) const;
  void start_queue();
  /// True: the budget is spent.
  bool expand_all(int budget);
  void expand(std::int32_t node);
  void trace(std::int32_t node);
  [[nodiscard]] std::int32_t nearest_reached() const;
  void copy_cost();

  [[nodiscard]] bool closed_diagonal(std::int32_t node, int k) const;
  [[nodiscard]] std::int32_t node_of(int cell) const { return node_at(cell % cells_.n, cell / cells_.n); }
  [[nodiscard]] std::int32_t node_at(int x, int y) const { return (y + 1) * (cells_.n + 2) + x + 1; }
  [[nodiscard]] int cell_of(std::int32_t node) const {
    const int wide = cells_.n + 2;
    return (node / wide - 1) * cells_.n + node % wide - 1;
  }

  Cells cells_;
  std::array<std::int32_t, 8> ways_{};  ///< Four straight ones, then diagonals; the last as in `kBeside`.
  std::int32_t vehicle_ = 0;
  int wanted_ = 0;  ///< How many are not reached.
  std::vector<Node> nodes_;
  std::vector<std::int32_t> list_;  ///< Seeds, or places to be looked around from.
  BucketQueue queue_;
  std::vector<float> cost_to_go_;
  std::vector<Eigen::Vector2d> path_;
};

}  // namespace gvom::planner
