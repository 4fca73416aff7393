// `ros2:/TOPIC` as a lidar's source.
#include <cstring>

#include "services/common/dds/reader.hpp"
#include "tests/dds/message_file.hpp"
#include "tests/ingest/bag_fixture.hpp"
#include "tests/ingest/live_socket.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/velodyne_builder.hpp"

using namespace gvom;
using namespace gvom::test;
using dds::test::MessageFile;
using dds::test::Peer;
using ingest::SourceEvent;
using namespace std::chrono_literals;

namespace {

constexpr std::int64_t kNoon_ns = 1'700'000'000'000'000'000;
const std::string kCloud = "sensor_msgs/msg/PointCloud2";

std::string uri_of(int domain, const std::string& options = "") {
  return "ros2:/lidar?interface=lo&domain=" + std::to_string(domain) + options;
}

/// Three points at (1 + i, 0, 0) m, 10 ms apart from `stamp_ns` on, by the field `time`.
Octets cloud_at(std::int64_t stamp_ns, const std::string& time = "t") {
  Octets data;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const float xyz[3] = {1.0F + static_cast<float>(i), 0, 0};
    const std::uint32_t time_ns = i * 10'000'000;
    data.resize(data.size() + 16);
    std::memcpy(data.data() + data.size() - 16, xyz, sizeof xyz);
    std::memcpy(data.data() + data.size() - 4, &time_ns, sizeof time_ns);
  }
  constexpr std::uint8_t kUint32 = 6, kFloat32 = 7;
  return cloud_message(
      stamp_ns, {{{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {time, 12, kUint32}}, 16},
      data);
}

/// The next sweep, however long it takes within reason.
bool next_sweep(ingest::Source& source, Sweep& out) {
  for (int i = 0; i < 200; ++i) {
    const auto event = source.next(out, 100ms);
    REQUIRE(event);
    if (*event == SourceEvent::kSweep) return true;
  }
  return false;
}

/// Waits for a counter; no sweep comes meanwhile.
template <typename Count>
bool counts(ingest::Source& source, const Count& count, std::uint64_t expected) {
  Sweep sweep;
  for (int i = 0; i < 200 && count(source.counters()) < expected; ++i)
    if (source.next(sweep, 100ms).value() == SourceEvent::kSweep) return false;
  return count(source.counters()) == expected;
}

/// A publisher that knows the source, and that the source knows: a reader beside it in the same participant
/// is told of publishers when the source's is.
struct Driver {
  Driver(const MessageFile& file, int domain, int publishers = 1) : peer(file.sender(domain, "/lidar")) {
    REQUIRE_FALSE(peer.line("matched").empty());
    dds::ParticipantOptions options;
    options.domain = {domain, "lo", {}, ""};
    auto beside = dds::Reader::open(dds::Participant::open(options).value(), {"/lidar", file.type(), ""});
    REQUIRE(beside);
    for (int i = 0; i < 200 && beside->publishers() != publishers; ++i) beside->take(100ms);
    REQUIRE(beside->publishers() == publishers);
  }
  Peer peer;
};

}  // namespace

TEST_CASE("a driver's cloud is a sweep, received when it came") {
  const auto source = open(uri_of(41), {0.5, 1000, false, 5});
  CHECK(source->is_live());
  CHECK_FALSE(source->rewind());
  Sweep sweep;
  CHECK(source->next(sweep, 0ms).value() == SourceEvent::kIdle);

  MessageFile clouds(kCloud);
  Driver driver(clouds.add(cloud_at(kNoon_ns)), 41);
  driver.peer.go();
  REQUIRE(next_sweep(*source, sweep));
  REQUIRE(sweep.returns.size() == 3);
  CHECK(sweep.returns[2].x_m == 3.0);
  CHECK(sweep.times_ns[sweep.returns[2].time_index] == kNoon_ns + 20'000'000 + 5);
  CHECK(sweep.stamp_ns == kNoon_ns + 20'000'000 + 5);
  CHECK(sweep.received_ns > 0);
  CHECK(source->counters().packets == 1);
  CHECK(source->counters().sweeps == 1);
  CHECK(source->counters().kernel_drops == 0);
}

TEST_CASE("a cloud that can't be deskewed is not used, and told once") {
  const auto source = open(uri_of(42));
  MessageFile clouds(kCloud);
  for (int i = 0; i < 2; ++i) clouds.add(cloud_at(kNoon_ns + i, "colour"));
  clouds.add(cloud_at(kNoon_ns + 100'000'000)).add({0, 1, 0, 0, 1});
  Driver driver(clouds, 42);
  const auto foreign = [](const auto& counters) { return counters.foreign_packets; };
  for (int i = 0; i < 2; ++i) driver.peer.go();
  REQUIRE(counts(*source, foreign, 2));
  REQUIRE(source->warnings().size() == 1);
  CHECK_THAT(source->warnings()[0], Catch::Contains("ros2 /lidar: ") && Catch::Contains("deskew"));
  driver.peer.go();
  Sweep sweep;
  CHECK(next_sweep(*source, sweep));
  driver.peer.go();  // cut
  CHECK(counts(*source, foreign, 3));
}

TEST_CASE("with deskew=off such a cloud is a sweep at its header's stamp") {
  const auto source = open(uri_of(43, "&deskew=off"));
  MessageFile clouds(kCloud);
  Driver driver(clouds.add(cloud_at(kNoon_ns, "colour")), 43);
  driver.peer.go();
  Sweep sweep;
  REQUIRE(next_sweep(*source, sweep));
  CHECK(sweep.stamp_ns == kNoon_ns);
}

TEST_CASE("a second publisher's clouds are not used while the first publishes") {
  const auto source = open(uri_of(44));
  MessageFile clouds(kCloud);
  for (int i = 0; i < 3; ++i) clouds.add(cloud_at(kNoon_ns + i * 100'000'000));
  Driver first(clouds, 44);
  Driver second(clouds, 44, 2);
  Sweep sweep;
  first.peer.go();
  REQUIRE(next_sweep(*source, sweep));
  second.peer.go();
  // Unless this machine stood still for a second in between, and the topic is the second's by right.
  const bool is_second = counts(
      *source, [](const auto& counters) { return counters.second_sensor_packets + counters.sweeps; }, 2);
  CHECK((is_second || source->counters().sweeps == 2));
}

TEST_CASE("a driver's Ouster packets are those of a port") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const auto source = open(uri_of(45, "&meta=" + meta));
  MessageFile packets("ouster_sensor_msgs/msg/PacketMsg");
  Driver driver(packets, 45);
  const auto add = [&](const Octets& message) {
    packets.add(message);
    driver.peer.go();
  };
  Sweep sweep;
  bool whole = false;
  std::uint64_t sent = 0;
  for (int frame = 1; frame <= 20 && !whole; ++frame) {  // see first_sweep()
    for (int column = 0; column < 16; column += 4) add(ouster_message(plain_packet({}, frame, column)));
    whole = read_to(*source, sweep, sent += 4) && sweep.complete;
  }
  REQUIRE(whole);
  CHECK(sweep.returns.size() == 32);
  CHECK(sweep.received_ns > 0);
  add({0, 1, 0, 0});
  CHECK(counts(
      *source, [](const auto& counters) { return counters.foreign_packets; }, 1));
  CHECK(source->counters().packets == sent + 1);
}

TEST_CASE("a driver's Velodyne scans are packets that came one after the other") {
  const auto source = open(uri_of(46, "&model=VLP-16"));
  MessageFile scans("velodyne_msgs/msg/VelodyneScan");
  const std::int64_t step_ns = 1'327'104;
  const std::vector<ByteVector> packets = turn(3);
  for (std::size_t first = 0; first + 75 <= packets.size(); first += 75)
    scans.add(velodyne_message(
        kNoon_ns + static_cast<std::int64_t>(first) * step_ns,
        {packets.begin() + static_cast<long>(first), packets.begin() + static_cast<long>(first) + 75},
        step_ns));
  Driver driver(scans, 46);
  for (int i = 0; i < 3; ++i) driver.peer.go();
  Sweep sweep;
  REQUIRE(next_sweep(*source, sweep));
  CHECK(sweep.complete);
  CHECK(sweep.returns.size() > 800);
  CHECK(source->counters().packets >= 75);
  CHECK(source->counters().foreign_packets == 0);
}

TEST_CASE("what cannot be a ROS 2 source is told by name") {
  CHECK(open_error("ros2:lidar?interface=lo") ==
        "source 'ros2:lidar?interface=lo': topic 'lidar' does not begin with a slash");
  CHECK_THAT(open_error("ros2:/lidar?domain=x"), Catch::Contains("domain: 'x' is not a whole number"));
  CHECK_THAT(open_error("ros2:/lidar?domain=233"), Catch::Contains("domain 233 is not within 0 .. 232"));
  CHECK_THAT(open_error("ros2:/lidar?distro=foxy"),
             Catch::Contains("distro: expected humble or jazzy, not 'foxy'"));
  CHECK_THAT(open_error("ros2:/lidar?bind=1"), Catch::Contains("unknown option 'bind'"));
  CHECK_THAT(open_error("ros2:/lidar?meta=a&model=b"), Catch::Contains("which is it?"));
  const auto gone = ingest::open_source("ros2:/lidar?interface=nosuch0", {});
  REQUIRE_FALSE(gone);
  CHECK(gone.error().kind == ingest::SourceError::Kind::unavailable);
  CHECK_THAT(gone.error().what, Catch::Contains("nosuch0"));
}
