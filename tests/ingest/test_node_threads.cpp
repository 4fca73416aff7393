// The threads of an ingest on a real bus: reader, loop, signals, and what each wakes. ThreadSanitizer watches
// in the preset "tsan".
#include <catch2/catch.hpp>

#include "core/cpu/voxelizer.hpp"
#include "ipc/brick_map.hpp"
#include "ipc/fixed.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_file.hpp"
#include "services/ingest/ingest_node.hpp"
#include "tests/common/temporary_file.hpp"
#include "tests/ingest/counting_source.hpp"
#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc::test;

namespace {

/// A sensor of two thousand sweeps a second, by this machine's clock.
class FastSensor final : public test::CountingSource {
 public:
  FastSensor() : CountingSource(true, 0) {}
  tl::expected<ingest::SourceEvent, std::string> next(Sweep& out,
                                                      std::chrono::milliseconds timeout) override {
    std::this_thread::sleep_for(500us);
    auto event = CountingSource::next(out, timeout);
    out.stamp_ns = out.times_ns.front() = ipc::monotonic_ns();
    return event;
  }
};

services::VehicleConfig configuration() {
  const test::TemporaryFile file(
      "name: threads\nmap: {size_xy: 64, size_z: 32}\n"
      "lidars: {front: {max_returns: 1000, T_base_sensor: {x: 0, y: 0, z: 1, roll: 0, pitch: 0, yaw: 0}}}\n");
  auto config = services::load_vehicle_config(file.path());
  REQUIRE(config);
  return *config;
}

/// A vehicle that stands, told a thousand times a second.
void odometry_life(const Step& stop) {
  auto runtime = ipc::Runtime::connect("odometry", kPatience).value();
  auto publisher = ipc::Publisher<ipc::Odometry>::open(runtime).value();
  ipc::Odometry pose{};
  pose.T_odom_base.orientation_xyzw[3] = 1;
  while (!stop.reached(1)) {
    EXPECT(publisher.publish(pose, ipc::monotonic_ns(), 1));
    std::this_thread::sleep_for(1ms);
  }
}

void ingest_life(const services::VehicleConfig& config) {
  services::Lifecycle lifecycle;
  const services::LidarConfig& lidar = config.lidars.front();
  auto runtime = services::join_bus("gvom-ingest-front", lifecycle);
  EXPECT(runtime);
  auto bus = ingest::Bus::open(*runtime, config, lidar.name);
  EXPECT(bus);
  const services::DeviceTrust trust(lidar.backend, "");
  ingest::IngestNode node(
      config, lidar, *runtime, *bus, lifecycle,
      {std::make_unique<FastSensor>(),
       trust,
       {std::make_unique<cpu::Voxelizer>(config.mapper.map, lidar.geometry, config.mapper.vehicle, 1000),
        "cpu", "in a test"}});
  EXPECT(node.run() == services::ExitCode::ok);
}

void reader_life() {
  constexpr int kMaps = 20;
  auto runtime = ipc::Runtime::connect("reader", kPatience).value();
  auto maps = ipc::BrickMapSubscriber::buffer_map(runtime, "front").value();
  for (int i = 0; i < kMaps; ++i) EXPECT(take_within(maps));
}

}  // namespace

TEST_CASE("an ingest under load ends at a signal, its threads with it") {
  const auto config = configuration();
  BrokerProcess broker(services::pool_spec(config));
  REQUIRE(broker.is_up());
  Step stop;
  Child odometry([&] { odometry_life(stop); });
  for (int round = 0; round < 5; ++round) {
    Child ingest([&] { ingest_life(config); });
    Child reader(reader_life);
    CHECK(reader.wait() == 0);
    ingest.send(SIGTERM);
    CHECK(ingest.wait() == 0);
  }
  stop.reach(1);
  CHECK(odometry.wait() == 0);
  CHECK(broker.stop() == 0);
}
