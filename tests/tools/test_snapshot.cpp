// gvom-snapshot as a process on a real bus: what it writes, when, and what it exits with.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "ipc/layers.hpp"
#include "tests/ipc/processes.hpp"
#include "tests/tools/layers_fixture.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/snapshot/folder.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;
using gvom::test::FlatWorld;
using gvom::test::TemporaryFolder;

namespace {

PoolSpec flat_world_spec() {
  PoolSpec spec = small_spec();
  spec.size_xy = FlatWorld::kSize;
  spec.size_z = 16;
  return spec;
}

void fill(const FlatWorld& world, LayersWriter& writer) {
  const auto picture = world.picture();
  Layers& header = writer.header();
  header.grid.origin = picture.origin_voxels;
  header.grid.resolution_m.fill(FlatWorld::kResolution_m);
  std::copy_n(picture.base_position_m.begin(), 3, header.T_odom_base.position_m);
  std::copy_n(picture.base_orientation_xyzw.begin(), 4, header.T_odom_base.orientation_xyzw);
  header.maps_in_window = 3;
  header.lidar_count = 1;
  std::strcpy(header.lidars[0].name, "rear");
  header.lidars[0].missing = 1;
  for (int i = 0; i < kLayers; ++i) {
    const auto id = static_cast<LayerId>(i);
    if (i < kFloatLayers) {
      std::copy_n(picture.floats(id), picture.columns(), writer.layer_f(id).begin());
    } else {
      std::copy_n(picture.bytes(id), picture.columns(), writer.layer_u8(id).begin());
    }
  }
}

/// Publishes the flat world, as soon as somebody reads, with stamps of 1 s, 2 s, ... `count` s; then it stays
/// until it is killed. `published` is how many so far.
std::function<void()> publisher(std::int64_t count, Step& published) {
  return [count, &published] {
    auto runtime = Runtime::connect("fusion", kPatience).value();
    auto out = LayersPublisher::open(runtime).value();
    EXPECT(eventually([&] { return out.has_subscribers(); }));
    const FlatWorld world;
    for (std::int64_t i = 1; i <= count; ++i) {
      auto writer = out.loan(FlatWorld::kSize, 16).value();
      fill(world, writer);
      out.publish(std::move(writer), i * 1'000'000'000, 0);
      published.reach(static_cast<int>(i));
      std::this_thread::sleep_for(20ms);
    }
    while (true) ::pause();
  };
}

/// A folder with the vehicle's file, and gvom-snapshot writing to its "out".
class Snapshot {
 public:
  Snapshot() {
    std::ofstream(folder_.path() + "/vehicle.yaml")
        << "name: flat\nmap: {size_xy: 32, size_z: 16}\n"
           "lidars: {rear: {T_base_sensor: {x: 0, y: 0, z: 2, roll: 0, pitch: 0, yaw: 0}}}\n";
  }

  std::function<void()> with(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"gvom-snapshot", "--config", folder_.path() + "/vehicle.yaml", "--out", out()});
    return [arguments, log = folder_.path() + "/log"] {
      std::vector<char*> argv;
      for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
      argv.push_back(nullptr);
      const int fd = ::open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
      ::dup2(fd, STDERR_FILENO);
      ::execv(GVOM_SNAPSHOT, argv.data());
      ::_exit(127);
    };
  }

  [[nodiscard]] std::string out() const { return folder_.path() + "/out"; }
  [[nodiscard]] bool has(const std::string& file) const {
    return std::filesystem::exists(out() + "/" + file);
  }
  [[nodiscard]] std::string log() const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() + "/log").rdbuf();
    return text.str();
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("without a broker it gives up after the timeout, with 75") {
  const Snapshot snapshot;
  CHECK(Child(snapshot.with({"--once", "--timeout", "0.3"})).wait() == 75);
  CHECK(!snapshot.log().empty());
}

TEST_CASE("without layers it gives up after the timeout, with 75") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  const Snapshot snapshot;
  CHECK(Child(snapshot.with({"--once", "--timeout", "0.5"})).wait() == 75);
  CHECK(snapshot.log().find("no layers came") != std::string::npos);
}

TEST_CASE("--once --npy writes the layers as they were published") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  Step published;
  Child fusion(publisher(1, published));
  const Snapshot snapshot;
  REQUIRE(Child(snapshot.with({"--once", "--npy"})).wait() == 0);
  CHECK(snapshot.has("montage.png"));
  CHECK(snapshot.has("obstacle_density.png"));
  CHECK(snapshot.log().find("lidar rear is missing") != std::string::npos);

  const auto read = gvom::snapshot::read_folder(snapshot.out() + "/000000");
  REQUIRE(read);
  CHECK(read->picture.vehicle == "flat");
  CHECK(read->picture.stamp_ns == 1'000'000'000);
  const FlatWorld world;
  for (std::size_t i = 0; i < world.floats.size(); ++i)
    CHECK(std::memcmp(read->picture.float_layers[i], world.floats[i].data(), 4 * world.floats[i].size()) ==
          0);
  for (std::size_t i = 0; i < world.bytes.size(); ++i) CHECK(read->byte_values[i] == world.bytes[i]);
}

TEST_CASE("--final writes nothing until SIGTERM, then the newest layers") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  const Snapshot snapshot;
  Child reader(snapshot.with({"--final", "--npy"}));
  Step published;
  Child fusion(publisher(20, published));
  REQUIRE(published.wait_for(20));
  CHECK(!snapshot.has("montage.png"));
  reader.send(SIGTERM);
  REQUIRE(reader.wait() == 0);
  CHECK(snapshot.has("montage.png"));
  CHECK(gvom::snapshot::read_folder(snapshot.out() + "/000000")->picture.stamp_ns == 20'000'000'000);
}

TEST_CASE("--every writes numbered montages, and at SIGTERM what is newer than the last") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  const Snapshot snapshot;
  Step published;
  Child fusion(publisher(1'000'000, published));
  Child reader(snapshot.with({"--every", "0.2"}));
  CHECK(eventually([&] { return snapshot.has("000001-montage.png"); }));
  const int before = published.now();
  CHECK(published.wait_for(before + 2));
  reader.send(SIGTERM);
  CHECK(reader.wait() == 0);
  CHECK(snapshot.has("000002-montage.png"));
}

TEST_CASE("a stop before any layers came is 75") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  const Snapshot snapshot;
  Child reader(snapshot.with({"--final"}));
  REQUIRE(takes_signals(reader.pid()));
  reader.send(SIGTERM);
  CHECK(reader.wait() == 75);
}

TEST_CASE("when the broker dies, what came is written and it ends with 75") {
  BrokerProcess broker(flat_world_spec());
  REQUIRE(broker.is_up());
  const Snapshot snapshot;
  Step published;
  Child fusion(publisher(1, published));
  Child reader(snapshot.with({"--final"}));
  REQUIRE(published.wait_for(1));
  broker.kill();
  CHECK(reader.wait() == 75);
  CHECK(snapshot.has("montage.png"));
}
