#include "tests/planner/slow_planning.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

namespace gvom::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<double> slow_distance(const std::vector<std::uint8_t>& marked, int n) {
  std::vector<double> distance(n * n, kInfinite);
  for (int a = 0; a < n * n; ++a) {
    for (int b = 0; b < n * n; ++b) {
      const double off = std::hypot(a % n - b % n, a / n - b / n);
      if (marked[b] && off < distance[a]) distance[a] = off;
    }
  }
  return distance;
}

std::vector<double> slow_cost_to_go(const std::vector<double>& cost, int n, double cell_m,
                                    const std::vector<SlowSeed>& seeds) {
  std::vector<double> to_go(n * n, kInfinite);
  std::set<std::pair<double, int>> open;
  for (const SlowSeed& seed : seeds) {
    to_go[seed.cell] = seed.cost;
    open.insert({seed.cost, seed.cell});
  }
  while (!open.empty()) {
    const auto [paid, cell] = *open.begin();
    open.erase(open.begin());
    const int x = cell % n, y = cell / n;
    for (int ny = y - 1; ny <= y + 1; ++ny) {
      for (int nx = x - 1; nx <= x + 1; ++nx) {
        if (nx < 0 || ny < 0 || nx >= n || ny >= n || std::isinf(cost[ny * n + nx])) continue;
        if (std::isinf(cost[ny * n + x]) && std::isinf(cost[y * n + nx])) continue;
        const double length_m = cell_m * std::hypot(nx - x, ny - y);
        const double total = paid + length_m * (cost[cell] + cost[ny * n + nx]) / 2;
        if (total >= to_go[ny * n + nx]) continue;
        open.erase({to_go[ny * n + nx], ny * n + nx});
        to_go[ny * n + nx] = total;
        open.insert({total, ny * n + nx});
      }
    }
  }
  return to_go;
}

}  // namespace gvom::test
