// More maps than fusion can fuse, without end.
#include <catch2/catch.hpp>

#include "ipc/brick_map.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_file.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ipc::test::Child;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

/// Empty maps of the lidar "front", 5,000 a second.
[[noreturn]] void flood(const Vehicle& vehicle) {
  const auto config = services::load_vehicle_config(vehicle.file, vehicle.sets).value();
  auto runtime = ipc::Runtime::connect("flood", 5s).value();
  auto maps =
      ipc::BrickMapPublisher::buffer_map(runtime, "front", buffer_map_capacity(services::pool_spec(config)))
          .value();
  const auto& size = config.mapper.map;
  const auto slots = static_cast<std::uint32_t>(size.size_xy * size.size_xy * size.size_z / 512);
  for (std::int64_t stamp_ns = 1'000'000'000;; stamp_ns += 1'000'000) {
    auto map = maps.loan({slots, 0, 0, ipc::columns(services::pool_spec(config))}).value();
    std::fill(map.directory().begin(), map.directory().end(), -1);
    std::fill(map.lowest_ray_m().begin(), map.lowest_ray_m().end(), kNoRay_m);
    ipc::BrickMap& header = map.header();
    for (int axis = 0; axis < 3; ++axis) {
      header.grid.size[axis] = axis < 2 ? size.size_xy : size.size_z;
      header.grid.origin[axis] = -header.grid.size[axis] / 2;
      header.grid.resolution_m[axis] = axis < 2 ? size.resolution_xy_m : size.resolution_z_m;
    }
    header.T_odom_base.orientation_xyzw[3] = 1;
    header.columns_seen_fraction = 1;
    header.mono_received_ns = ipc::monotonic_ns();
    maps.publish(std::move(map), stamp_ns, 1);
    std::this_thread::sleep_for(200us);
  }
}

}  // namespace

TEST_CASE("fusion goes on telling how it is though its queue is never empty") {
  const TemporaryFolder folder;
  Vehicle vehicle = front_only(folder.path());  // with layers that take a while
  vehicle.sets = {"map.size_xy=512",      "map.size_z=32",      "lidars.front.max_returns=1024",
                  "window.buffer_size=2", "ipc.max_planners=2", "fusion.voxel_rate_hz=0"};
  Graph graph(vehicle);
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_fusion();
  const Child flooding([&] { flood(vehicle); });
  const auto lost = [&] { return observer.counter("gvom-fusion", "maps_lost"); };
  REQUIRE(eventually([&] { return lost() > 0; }));  // its Health says so
  for (int i = 0; i < 2; ++i) {
    const std::uint64_t before = lost();
    CHECK(eventually([&] { return lost() > before; }));
  }
  CHECK(observer.counter("gvom-fusion", "maps_fused") > 0);
}
