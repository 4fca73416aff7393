// What the planner computes, the slow obvious way. Shares no code with it.
#pragma once

#include <cstdint>
#include <vector>

namespace gvom::test {

/// From each of n * n cells' middles to the nearest marked one's, in cells; infinite without any.
std::vector<double> slow_distance(const std::vector<std::uint8_t>& marked, int n);

/// A cell from which ways begin, and what it costs from there.
struct SlowSeed {
  int cell;
  double cost;
};

/// Dijkstra's costs to go over n * n cells of `cell_m` with a cost per metre each, infinite: no way. No
/// diagonal step between two such cells.
std::vector<double> slow_cost_to_go(const std::vector<double>& cost, int n, double cell_m,
                                    const std::vector<SlowSeed>& seeds);

}  // namespace gvom::test
