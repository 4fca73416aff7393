// A planner in thirty lines: prints the cost ahead of the vehicle and how old the layers are.
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "ipc/planner.hpp"

using namespace std::chrono_literals;

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
    const auto cost = layers->layer_u8(gvom::LayerId::cost);  // read where fusion wrote it
    const auto& base = layers->header().T_odom_base.position_m;
    const auto& q = layers->header().T_odom_base.orientation_xyzw;
    const double yaw = std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
    std::printf("cost ahead:");
    for (int metres = 2; metres <= 10; metres += 2) {
      const auto column =
          layers->index_of(base[0] + metres * std::cos(yaw), base[1] + metres * std::sin(yaw));
      std::printf(" %3d", column ? cost[*column] : 255);
    }
    std::printf("  age %.1f ms  lost %llu\n", static_cast<double>(layers->age().count()) * 1e-6,
                static_cast<unsigned long long>(client->counters().lost));
  }
}
