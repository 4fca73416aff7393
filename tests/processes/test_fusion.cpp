// Fusion that was held up, and beside lidars that it does not know.
#include <catch2/catch.hpp>

#include <string>

#include "core/grid.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/freshness.hpp"
#include "ipc/text.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_file.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using ipc::test::Child;
using ipc::test::eventually;
using ipc::test::Step;
using namespace std::chrono_literals;

namespace {

constexpr char kFusion[] = "gvom-fusion";
constexpr int kQueued = 10;
constexpr std::int64_t kPeriod_ns = 100'000'000;

ipc::Runtime join() {
  return ipc::Runtime::connect("empty-maps", 5s).value();
}

/// Empty maps of one lidar.
class EmptyMaps {
 public:
  EmptyMaps(const Vehicle& vehicle, ipc::Runtime& runtime, const std::string& lidar)
      : config_(services::load_vehicle_config(vehicle.file, vehicle.sets).value()),
        maps_(ipc::BrickMapPublisher::buffer_map(runtime, lidar,
                                                 buffer_map_capacity(services::pool_spec(config_)))
                  .value()) {
    EXPECT(eventually([&] { return maps_.has_subscribers(); }));
  }

  /// `jump`: the number of the first map after the odometry's last jump; 0: it has not jumped.
  void publish(int number, int jump = 0) {
    const auto& size = config_.mapper.map;
    const auto slots = static_cast<std::uint32_t>(size.size_xy * size.size_xy * size.size_z / 512);
    auto map = maps_.loan({slots, 0, 0, ipc::columns(services::pool_spec(config_))}).value();
    std::fill(map.directory().begin(), map.directory().end(), -1);
    std::fill(map.lowest_ray_m().begin(), map.lowest_ray_m().end(), kNoRay_m);
    ipc::BrickMap& header = map.header();
    header.grid = grid_around(size, Eigen::Vector3d::Zero());
    header.T_odom_base.orientation_xyzw[3] = 1;
    header.columns_seen_fraction = 0.75F;
    header.odometry_jump_ns = jump * kPeriod_ns;
    header.mono_received_ns = ipc::monotonic_ns();
    header.suspended_ns = ipc::suspended_ns();
    maps_.publish(std::move(map), number * kPeriod_ns, 1);
  }

 private:
  services::VehicleConfig config_;
  ipc::BrickMapPublisher maps_;
};

std::string reason_of(const Observer& observer) {
  const auto health = observer.health(kFusion);
  const bool degraded = health && health->state == static_cast<std::uint32_t>(ipc::HealthState::degraded);
  return degraded ? std::string(ipc::text_of(health->reason)) : "";
}

}  // namespace

TEST_CASE("fusion that was held up makes layers of the newest map at once, and says how far it was behind") {
  const TemporaryFolder folder;
  Graph graph(front_only(folder.path()));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_fusion();
  Step held;
  Step queued;
  const Child publisher([&] {
    auto runtime = join();
    EmptyMaps maps(graph.vehicle(), runtime, "front");
    maps.publish(1);
    EXPECT(held.wait_for(1));
    for (int i = 1; i <= kQueued; ++i) {
      maps.publish(1 + i);
      std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriod_ns));  // the pace of a lidar
    }
    queued.reach(1);
    while (true) ::pause();
  });
  REQUIRE(eventually([&] { return observer.layers() == 1; }));
  CHECK(observer.newest_layers().lidars[0].columns_seen_fraction == 0.75F);
  graph.fusion().send(SIGSTOP);
  held.reach(1);
  REQUIRE(queued.wait_for(1));
  graph.fusion().send(SIGCONT);
  REQUIRE(eventually([&] { return observer.layers() == 2; }));
  CHECK(observer.newest_layers().header.stamp_ns == (1 + kQueued) * kPeriod_ns);
  CHECK(observer.newest_layers().maps_in_window == 4);
  std::string reason;
  CHECK(
      eventually([&] {  // at first the layers are old; once there are newer ones, it says how late these came
        reason = reason_of(observer);
        return reason.find("behind the packets") != std::string::npos;
      }));
  INFO(reason);
  CHECK(eventually([&] { return observer.counter(kFusion, "maps_fused") == 1 + kQueued; }));
  CHECK(observer.counter(kFusion, "maps_sharing_layers") == kQueued - 1);
  CHECK(observer.layers() == 2);
  CHECK(observer.counter(kFusion, "layers_out") == 2);

  // Nothing comes any more: the layers grow old, and fusion says so.
  CHECK(
      eventually([&] { return reason_of(observer).find("no maps: the layers are ") != std::string::npos; }));
}

TEST_CASE("after a jump of the odometry nothing is left of a lidar that has not come since") {
  const TemporaryFolder folder;
  Graph graph(two_lidars(folder.path()));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_fusion();
  Step both;
  const Child publisher([&] {
    auto runtime = join();
    EmptyMaps front(graph.vehicle(), runtime, "front");
    EmptyMaps rear(graph.vehicle(), runtime, "rear");
    front.publish(1);
    rear.publish(1);
    EXPECT(both.wait_for(1));
    front.publish(2, 2);
    while (true) ::pause();
  });
  const auto stamps_are = [&](std::int64_t front_ns, std::int64_t rear_ns) {
    const ipc::Layers layers = observer.newest_layers();
    return layers.lidar_count == 2 && layers.lidars[0].newest_stamp_ns == front_ns &&
           layers.lidars[1].newest_stamp_ns == rear_ns;
  };
  REQUIRE(eventually([&] { return stamps_are(kPeriod_ns, kPeriod_ns); }));
  CHECK(observer.newest_layers().lidars[1].missing == 0);
  both.reach(1);
  REQUIRE(eventually([&] { return stamps_are(2 * kPeriod_ns, 0); }));
  const ipc::LidarStatus rear = observer.newest_layers().lidars[1];
  CHECK(rear.missing == 1);
  CHECK(rear.maps_in_window == 0);
  CHECK(rear.columns_seen_fraction == 0);
  CHECK(observer.newest_layers().maps_in_window == 1);
}

TEST_CASE("a lidar that fusion does not know is named by Health and Layers, and is no part of the map") {
  const TemporaryFolder folder;
  const Vehicle both = simulated(folder.path(), 1);
  Graph graph(front_only(folder.path()));  // as the file was when fusion was started
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  const auto layers_know_rear = [&] {
    const ipc::Layers layers = observer.newest_layers();
    return layers.lidar_count == 2 && ipc::text_of(layers.lidars[1].name) == "rear" &&
           layers.lidars[1].unknown == 1 && layers.lidars[1].missing == 1;
  };
  REQUIRE(observer.sees(kFusion, ipc::HealthState::ok));
  CHECK(observer.newest_layers().lidar_count == 1);
  Program rear("gvom-ingest", both.arguments({"--lidar", "rear"}), folder.path());
  CHECK(eventually(layers_know_rear));
  CHECK(eventually([&] {
    return reason_of(observer) == "lidar rear is not in this configuration: its maps are not taken";
  }));
  CHECK(observer.newest_layers().lidars[0].missing == 0);
  CHECK(rear.stop() == 0);
  CHECK(eventually([&] { return observer.newest_layers().lidar_count == 1; }));
  CHECK(observer.sees(kFusion, ipc::HealthState::ok));
  CHECK(odometry->stop() == 0);
  graph.stop();
}
