// A reader of the fused voxels: counts those with hits, and says what is known of the one a metre above
// base_link.
#include <unistd.h>

#include <cstdio>

#include "ipc/brick_map.hpp"
#include "ipc/freshness.hpp"
#include "ipc/runtime.hpp"
#include "ipc/waiter.hpp"

using namespace std::chrono_literals;

int main() {
  auto runtime = gvom::ipc::Runtime::connect("my-voxel-reader", 10s);
  if (!runtime) {
    std::fprintf(stderr, "%s\n", runtime.error().message.c_str());
    return 69;
  }
  auto maps = gvom::ipc::BrickMapSubscriber::voxel_map(*runtime);
  if (!maps) {
    std::fprintf(stderr, "%s\n", maps.error().message.c_str());
    return 69;
  }
  auto waiter = gvom::ipc::Waiter::create(*runtime);
  waiter.add(*maps);
  while (runtime->broker_alive()) {
    waiter.wait(1s);
    while (const auto sample = maps->take()) {
      const auto age = gvom::ipc::elapsed(gvom::ipc::received_at(sample->header()), gvom::ipc::Moment::now());
      if (age > gvom::ipc::kDefaultMaxAge || !sample->validate_deep()) continue;
      const gvom::BrickMapView map = sample->view();
      int hit = 0;
      map.for_each_hit([&hit](const gvom::Int3&, const gvom::VoxelRecord&) { ++hit; });
      const auto& base = map.T_odom_base.position_m;
      const gvom::VoxelRecord above = map.voxel_at_m(base[0], base[1], base[2] + 1);
      std::printf("%d voxels hit; a metre above base_link: %u hits, %u passes\n", hit, above.hits,
                  above.passes);
    }
  }
  _exit(75);  // the broker is gone: to be started again
}
