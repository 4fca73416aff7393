// The smallest driver: straight on at 1 m/s while the next four metres can be driven on, else it stands.
// Publishes Command as gvom-planner does, so whoever moves a vehicle by that moves it by this.
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "ipc/clock.hpp"
#include "ipc/planner.hpp"

using namespace std::chrono_literals;

namespace {

constexpr int kMostCost = 252;                      // of ground that can be driven on; 255: not known
constexpr std::int64_t kDeadline_ns = 250'000'000;  // without a newer command the vehicle stops by itself

bool is_free_ahead(const gvom::ipc::LayersSample& layers) {
  const auto cost = layers.layer_u8(gvom::LayerId::cost);
  const auto& base = layers.header().T_odom_base.position_m;
  const auto& q = layers.header().T_odom_base.orientation_xyzw;
  const double yaw = std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
  for (double ahead_m = 0; ahead_m < 4; ahead_m += 0.2)
    for (double aside_m = -1; aside_m <= 1; aside_m += 0.2) {
      const double x_m = base[0] + ahead_m * std::cos(yaw) - aside_m * std::sin(yaw);
      const double y_m = base[1] + ahead_m * std::sin(yaw) + aside_m * std::cos(yaw);
      const auto column = layers.index_of(x_m, y_m);
      if (!column || cost[*column] > kMostCost) return false;
    }
  return true;
}

}  // namespace

int main() {
  auto client = gvom::ipc::PlannerClient::connect("my-driver", 10s);
  if (!client) return std::fprintf(stderr, "%s\n", client.error().message.c_str()), 69;
  auto commands = gvom::ipc::Publisher<gvom::ipc::Command>::open(client->runtime());
  if (!commands) return std::fprintf(stderr, "%s\n", commands.error().message.c_str()), 69;
  while (true) {
    const auto layers = client->newest_layers(100ms);  // by default none whose data are over 0.5 s old
    if (!layers && layers.error().kind == gvom::ipc::ErrorKind::unavailable) _exit(75);
    if (!layers && layers.error().kind == gvom::ipc::ErrorKind::timeout) continue;  // the last command ends
    const bool drives = layers && layers->missing_lidars().empty() && is_free_ahead(*layers);
    gvom::ipc::Command command{};
    command.speed_mps = drives ? 1.0 : 0.0;
    command.mode =
        static_cast<std::uint32_t>(drives ? gvom::ipc::PlanMode::drive : gvom::ipc::PlanMode::stop);
    command.mono_deadline_ns = gvom::ipc::monotonic_ns() + kDeadline_ns;
    const gvom::ipc::MessageHeader of = layers ? layers->header().header : gvom::ipc::MessageHeader{};
    if (!commands->publish(command, of.stamp_ns, of.epoch)) std::fprintf(stderr, "a command is lost\n");
    std::printf("%s\n", drives   ? "drives"
                        : layers ? "stands: not free ahead"
                                 : layers.error().message.c_str());
    std::fflush(stdout);  // _exit doesn't
  }
}
