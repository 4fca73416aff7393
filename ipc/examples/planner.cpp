// A small planner: prints the cost ahead of the vehicle, with an r where it is of remembered ground,
// how old the layers are, and which lidars are missing.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "ipc/planner.hpp"

using namespace std::chrono_literals;

namespace {

constexpr int kMostCost = 252;       // of ground that can be driven on
constexpr int kUnknownCost = 255;    // of ground that is not known, and not driven on
constexpr int kRememberedCost = 50;  // more, where no lidar sees any more

/// What it costs to drive there. Remembered ground is as it was when it was seen, up to 5 s ago: who came
/// since is not in its cost. In the blind ring around the vehicle that is worth a little. Of a lidar that is
/// missing it is the whole side, and nobody looks there again: not driven on.
int cost_of(std::uint8_t cost, bool remembered, bool blind_side) {
  if (!remembered || cost > kMostCost) return cost;
  return blind_side ? kUnknownCost : std::min(cost + kRememberedCost, kMostCost);
}

void print_cost_ahead(const gvom::ipc::LayersSample& layers, bool blind_side) {
  const auto cost = layers.layer_u8(gvom::LayerId::cost);  // read where fusion wrote it
  const auto visibility = layers.layer_u8(gvom::LayerId::visibility);
  const auto& base = layers.header().T_odom_base.position_m;
  const auto& q = layers.header().T_odom_base.orientation_xyzw;
  const double yaw = std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
  std::printf("cost ahead:");
  for (int metres = 2; metres <= 10; metres += 2) {
    const auto column = layers.index_of(base[0] + metres * std::cos(yaw), base[1] + metres * std::sin(yaw));
    const bool remembered = column && gvom::is_remembered(visibility[*column]);
    std::printf(" %3d%c", column ? cost_of(cost[*column], remembered, blind_side) : kUnknownCost,
                remembered ? 'r' : ' ');
  }
}

}  // namespace

int main() {
  auto client = gvom::ipc::PlannerClient::connect("my-planner", 10s);
  if (!client) {
    std::fprintf(stderr, "%s\n", client.error().message.c_str());
    return 69;
  }
  while (true) {
    auto layers = client->newest_layers(1s);
    if (!layers) {
      std::fprintf(stderr, "%s\n", layers.error().message.c_str());
      if (layers.error().kind == gvom::ipc::ErrorKind::unavailable) _exit(75);  // to be started again
      continue;  // stand still: there is no map (timeout), or it is old (stale: the message says by how much)
    }
    const auto missing = layers->missing_lidars();
    print_cost_ahead(*layers, !missing.empty());
    std::printf("  age %.1f ms  lost %llu", static_cast<double>(layers->age().count()) * 1e-6,
                static_cast<unsigned long long>(client->counters().lost));
    for (const auto& lidar : missing) std::printf("  missing: %s", lidar.c_str());
    std::printf("\n");
    std::fflush(stdout);  // _exit doesn't
  }
}
