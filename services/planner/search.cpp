#include "services/planner/search.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::planner {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr float kDiagonal = 1.41421356F;
// The two straight ways beside each diagonal one, as indices of `ways_`.
constexpr int kBeside[8][2] = {{}, {}, {}, {}, {0, 2}, {1, 2}, {0, 3}, {1, 3}};

std::size_t nodes_of(int n) {
  return static_cast<std::size_t>(n + 2) * (n + 2);
}

}  // namespace

Search::Search(int n_xy)
    : nodes_(nodes_of(n_xy)),
      queue_(static_cast<int>(nodes_of(n_xy))),
      cost_to_go_(static_cast<std::size_t>(n_xy) * n_xy) {
  list_.reserve(cost_to_go_.size());
  path_.reserve(cost_to_go_.size());
}

SearchResult Search::run(const Costmap& map, const Eigen::Vector2d& vehicle_m, const Eigen::Vector2d& goal_m,
                         double around_m, int budget) {
  cells_ = map.cells();
  path_.clear();
  const int cell = cells_.index_of(vehicle_m.x(), vehicle_m.y());
  if (cell < 0) {
    std::fill_n(cost_to_go_.begin(), cells_.count(), kNever);
    return SearchResult::no_way;
  }
  vehicle_ = node_of(cell);
  prepare(map, vehicle_m, around_m);
  const bool goal_on_map = cells_.index_of(goal_m.x(), goal_m.y()) >= 0;
  SearchResult result = goal_on_map ? SearchResult::goal_in_obstacle : SearchResult::no_way;
  if (seed(map, goal_m)) {
    start_queue();
    const bool spent = expand_all(budget);
    if (nodes_[vehicle_].cost < kNever) {
      trace(vehicle_);
      result = SearchResult::found;
    } else if (spent) {
      path_.push_back(cells_.center_of(cell));
      trace(nearest_reached());
      result = SearchResult::cut;
    } else {
      const bool free = map.cost()[cell] < kLethalCost;
      result = free ? SearchResult::no_way : SearchResult::vehicle_in_obstacle;
    }
  }
  copy_cost();
  return result;
}

void Search::prepare(const Costmap& map, const Eigen::Vector2d& vehicle_m, double around_m) {
  const int n = cells_.n, wide = n + 2;
  const auto cell_m = static_cast<float>(cells_.cell_m);
  ways_ = {-1, 1, -wide, wide, -wide - 1, -wide + 1, wide - 1, wide + 1};
  std::fill_n(nodes_.begin(), nodes_of(n), Node{kNever, kNever, 0, 0});
  const int vehicle_cell = cells_.index_of(vehicle_m.x(), vehicle_m.y());
  const int vx = vehicle_cell % n, vy = vehicle_cell / n;
  for (int y = 0; y < n; ++y) {
    Node* const nodes = nodes_.data() + node_at(0, y);
    const float* const cost = map.cost() + y * n;
    for (int x = 0; x < n; ++x) {
      const auto dx = static_cast<float>(std::abs(x - vx)), dy = static_cast<float>(std::abs(y - vy));
      const float steps = std::max(dx, dy) + (kDiagonal - 1) * std::min(dx, dy);
      nodes[x].half_edge = cost[x] * cell_m / 2;
      nodes[x].ahead = steps * cell_m;
    }
  }
  open_around_vehicle(map);
  want_around_vehicle(around_m);
}

void Search::open_around_vehicle(const Costmap& map) {
  const auto most = static_cast<float>(Costmap::kMostCost * cells_.cell_m / 2);
  const Eigen::Vector2d vehicle = cells_.center_of(cell_of(vehicle_));
  const double radius_m = map.vehicle_length_m() / 2;
  const int reach = static_cast<int>(radius_m / cells_.cell_m);
  const int vx = cell_of(vehicle_) % cells_.n, vy = cell_of(vehicle_) / cells_.n;
  for (int y = std::max(vy - reach, 0); y <= std::min(vy + reach, cells_.n - 1); ++y) {
    for (int x = std::max(vx - reach, 0); x <= std::min(vx + reach, cells_.n - 1); ++x) {
      float& half_edge = nodes_[node_at(x, y)].half_edge;
      const bool near = (cells_.center_of(y * cells_.n + x) - vehicle).norm() <= radius_m;
      if (near && half_edge == kNever) half_edge = most;
    }
  }
}

// What is connected to the vehicle within `around_m`. Whatever reaches the vehicle reaches that.
void Search::want_around_vehicle(double around_m) {
  const int wide = cells_.n + 2, vx = vehicle_ % wide, vy = vehicle_ / wide;
  const double most = std::pow(around_m / cells_.cell_m, 2);
  list_.assign(1, vehicle_);
  nodes_[vehicle_].wanted = 1;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const std::int32_t next = list_[i] + ways_[k];
      const int dx = next % wide - vx, dy = next / wide - vy;
      Node& node = nodes_[next];
      if (node.wanted || node.half_edge == kNever || dx * dx + dy * dy > most) continue;
      if (k >= 4 && closed_diagonal(list_[i], k)) continue;
      node.wanted = 1;
      list_.push_back(next);
    }
  }
  wanted_ = static_cast<int>(list_.size());
}

bool Search::seed(const Costmap& map, const Eigen::Vector2d& goal_m) {
  list_.clear();
  if (cells_.index_of(goal_m.x(), goal_m.y()) < 0) {
    seed_border(goal_m);
  } else if (const std::int32_t cell = free_cell_near(map, goal_m); cell >= 0) {
    list_.push_back(node_of(cell));
    nodes_[list_.back()].cost = 0;
  }
  return !list_.empty();
}

void Search::seed_border(const Eigen::Vector2d& goal_m) {
  const int last = cells_.n - 1;
  for (int y = 0; y <= last; ++y) {
    for (int x = 0; x <= last; x += y == 0 || y == last ? 1 : last) {
      Node& node = nodes_[node_at(x, y)];
      if (node.half_edge == kNever) continue;
      const Eigen::Vector2d off = goal_m - cells_.center_of(y * cells_.n + x);
      node.cost = static_cast<float>(kBeyond * off.norm());
      list_.push_back(node_at(x, y));
    }
  }
}

// The goal's own cell, if it is free; -1: none is near enough.
std::int32_t Search::free_cell_near(const Costmap& map, const Eigen::Vector2d& goal_m) const {
  const int cell = cells_.index_of(goal_m.x(), goal_m.y());
  if (map.cost()[cell] < kLethalCost) return cell;
  const int reach = static_cast<int>(kGoalSlack_m / cells_.cell_m) + 1;
  const int gx = cell % cells_.n, gy = cell / cells_.n;
  std::int32_t nearest = -1;
  double least_m = kGoalSlack_m;
  for (int y = std::max(gy - reach, 0); y <= std::min(gy + reach, cells_.n - 1); ++y) {
    for (int x = std::max(gx - reach, 0); x <= std::min(gx + reach, cells_.n - 1); ++x) {
      const int candidate = y * cells_.n + x;
      const double off_m = (cells_.center_of(candidate) - goal_m).norm();
      if (!(map.cost()[candidate] < kLethalCost) || off_m > least_m) continue;
      if (nearest >= 0 && off_m == least_m) continue;
      nearest = candidate;
      least_m = off_m;
    }
  }
  return nearest;
}

void Search::start_queue() {
  float lowest = kNever, highest = 0, dearest = 0;
  for (const std::int32_t node : list_) {
    const float key = nodes_[node].cost + nodes_[node].ahead;
    lowest = std::min(lowest, key);
    highest = std::max(highest, key);
  }
  for (std::size_t i = 0; i < nodes_of(cells_.n); ++i) {
    const float half_edge = nodes_[i].half_edge;
    dearest = std::max(dearest, half_edge < kNever ? half_edge : 0);
  }
  // An edge between two of the dearest, and what it leads away from the vehicle.
  const auto cell_m = static_cast<float>(cells_.cell_m);
  const float step = kDiagonal * (2 * dearest + cell_m);
  queue_.clear(lowest, std::max(highest - lowest, step), cell_m);
  for (const std::int32_t node : list_) queue_.put(node, nodes_[node].cost + nodes_[node].ahead);
}

// A cell that was taken may get cheaper while its bucket lasts, not later: then the bucket of the last wanted
// cell is done to its end, and all costs up to there are exact.
bool Search::expand_all(int budget) {
  for (int looked_at = 0; wanted_ > 0 || !queue_.bucket_is_empty(); ++looked_at) {
    if (looked_at == budget) return true;
    const std::int32_t node = queue_.take();
    if (node == BucketQueue::kNone) return false;
    wanted_ -= nodes_[node].wanted;
    nodes_[node].wanted = 0;
    expand(node);
  }
  return false;
}

void Search::expand(std::int32_t at) {
  const Node here = nodes_[at];
  for (int k = 0; k < 8; ++k) {
    const std::int32_t next = at + ways_[k];
    Node& node = nodes_[next];
    const float edge = here.half_edge + node.half_edge;
    const float cost = here.cost + (k < 4 ? edge : kDiagonal * edge);
    if (!(cost < node.cost) || (k >= 4 && closed_diagonal(at, k))) continue;
    node.cost = cost;
    queue_.put(next, cost + node.ahead);
  }
}

bool Search::closed_diagonal(std::int32_t node, int k) const {
  return nodes_[node + ways_[kBeside[k][0]]].half_edge == kNever &&
         nodes_[node + ways_[kBeside[k][1]]].half_edge == kNever;
}

// Down the costs to go, to a seed: there no neighbour is the cheaper way.
void Search::trace(std::int32_t at) {
  for (std::int32_t next = at; next >= 0; at = next) {
    path_.push_back(cells_.center_of(cell_of(at)));
    const Node here = nodes_[at];
    next = -1;
    float least = here.cost;
    for (int k = 0; k < 8; ++k) {
      const Node& node = nodes_[at + ways_[k]];
      const float edge = (here.half_edge + node.half_edge) * (k < 4 ? 1 : kDiagonal);
      if (!(node.cost < here.cost) || node.cost + edge > least) continue;
      if ((next >= 0 && node.cost + edge == least) || (k >= 4 && closed_diagonal(at, k))) continue;
      least = node.cost + edge;
      next = at + ways_[k];
    }
  }
}

std::int32_t Search::nearest_reached() const {
  const int wide = cells_.n + 2, vx = vehicle_ % wide, vy = vehicle_ / wide;
  std::int32_t nearest = list_.front();
  int least = std::numeric_limits<int>::max();
  for (int y = 1; y <= cells_.n; ++y) {
    for (int x = 1; x <= cells_.n; ++x) {
      const int off = (x - vx) * (x - vx) + (y - vy) * (y - vy);
      if (off >= least || nodes_[y * wide + x].cost == kNever) continue;
      nearest = y * wide + x;
      least = off;
    }
  }
  return nearest;
}

void Search::copy_cost() {
  for (int y = 0; y < cells_.n; ++y) {
    const Node* const nodes = nodes_.data() + node_at(0, y);
    float* const out = cost_to_go_.data() + y * cells_.n;
    for (int x = 0; x < cells_.n; ++x) out[x] = nodes[x].cost;
  }
}

}  // namespace gvom::planner
