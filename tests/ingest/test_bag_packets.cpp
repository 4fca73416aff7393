// Packets out of a bag: the sweeps are those of the same packets in a pcap, to the bit.
#include <cstring>

#include "services/common/bag/bag_reader.hpp"
#include "services/common/ros/incoming.hpp"
#include "services/ingest/bag_source.hpp"
#include "tests/ingest/bag_fixture.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/velodyne_builder.hpp"
#include "tests/support/db3_builder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr std::int64_t kNoon_ns = 1'700'000'000'000'000'000;
const std::string kOusterType = "ouster_sensor_msgs/msg/PacketMsg";
const std::string kVelodyneType = "velodyne_msgs/msg/VelodyneScan";

}  // namespace

TEST_CASE("Ouster packets of a bag of either storage give the sweeps of a pcap") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  PcapWriter pcap(folder.path() + "/a.pcap", 1, true);
  TopicBag mcap(kOusterType);
  {
    Db3Builder db3(folder.path() + "/a.db3");
    const int topic = db3.topic("/lidar", kOusterType);
    std::int64_t time_ns = kNoon_ns;
    for (int i = 0; i < 5; ++i)
      for (int column = 0; column < 16; column += 4) {
        if (i == 3 && column == 8) continue;  // lost
        const ByteVector packet = plain_packet({}, i, column);
        time_ns += 1'000'000;
        pcap.add(frame(packet), time_ns);
        db3.add(topic, time_ns, ouster_message(packet));
        mcap.add(time_ns, ouster_message(packet));
      }
  }
  for (const ingest::SourceOptions& options :
       {ingest::SourceOptions{}, ingest::SourceOptions{0.5, 1000, true, 5'000'000}}) {
    const auto expected = all_sweeps(*open("ouster:" + pcap.write() + "?meta=" + meta, options));
    REQUIRE(expected.size() == 5);
    require_same(all_sweeps(*open(mcap.uri("&meta=" + meta), options)), expected);
    const auto source = open("bag:" + folder.path() + "/a.db3?topic=/lidar&meta=" + meta, options);
    require_same(all_sweeps(*source), expected);
    CHECK(source->counters().incomplete_sweeps == 1);
    CHECK(source->warnings().empty());
    REQUIRE(source->rewind().has_value());
    require_same(all_sweeps(*source), expected);
  }
}

TEST_CASE("Ouster packets with the spare byte of a driver's buffer are read all the same") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  TopicBag bag(kOusterType);
  for (int column = 0; column < 16; column += 4) {
    ByteVector packet = plain_packet({}, 1, column);
    packet.push_back(0xAB);
    bag.add(kNoon_ns + column, ouster_message(packet));
  }
  const auto source = open(bag.uri("&meta=" + meta));
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].complete);
  CHECK(source->counters().foreign_packets == 0);
}

TEST_CASE("Velodyne scans give the sweeps of a pcap, with the packets' own stamps") {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/a.pcap", 1, true);
  TopicBag bag(kVelodyneType);
  const std::vector<ByteVector> packets = turn(3);
  const std::int64_t step_ns = 1'327'104;
  for (std::size_t first = 0; first < packets.size(); first += 50) {
    const auto end = packets.begin() + static_cast<long>(std::min(first + 50, packets.size()));
    const std::int64_t stamp_ns = kNoon_ns + static_cast<std::int64_t>(first) * step_ns;
    bag.add(kNoon_ns + 5'000'000'000,  // the recorder was late
            velodyne_message(stamp_ns, {packets.begin() + static_cast<long>(first), end}, step_ns));
  }
  for (std::size_t i = 0; i < packets.size(); ++i)
    pcap.add(frame(packets[i], {1, 2368, 1}), kNoon_ns + static_cast<std::int64_t>(i) * step_ns);
  const auto expected = all_sweeps(*open("velodyne:" + pcap.write() + "?model=VLP-16"));
  REQUIRE(expected.size() >= 2);
  require_same(all_sweeps(*open(bag.uri("&model=VLP-16"))), expected);
}

TEST_CASE("a message that is not what its type says is passed over, counted and told") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  TopicBag bag(kOusterType);
  std::int64_t time_ns = kNoon_ns;
  for (int column = 0; column < 16; column += 4) {
    bag.add(++time_ns, ouster_message(plain_packet({}, 0, column)));
    bag.add(++time_ns, {0, 1, 0, 0, 255, 255, 0, 0});
  }
  const auto source = open(bag.uri("&meta=" + meta));
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].complete);
  CHECK(source->counters().packets == 4);
  CHECK(source->counters().foreign_packets == 4);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("bag.mcap /lidar: message 2: byte 8: a sequence of 65535 elements") !=
        std::string::npos);
}

TEST_CASE("a bag's topic that can't be a lidar is refused with what helps") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  TopicBag ouster(kOusterType);
  ouster.add(kNoon_ns, ouster_message(ByteVector(48)));
  CHECK(open_error("bag:" + folder.path()).find("needs topic=TOPIC (gvomctl bag ") != std::string::npos);
  CHECK(open_error("bag:?topic=/lidar").find("(--bag PATH of gvom-map and gvom-run fills that in)") !=
        std::string::npos);
  CHECK(open_error(ouster.uri()).find("needs meta=FILE.json") != std::string::npos);
  CHECK(open_error(ouster.uri("&model=VLP-16"))
            .find("unknown option 'model' (bag takes meta, serial, topic)") != std::string::npos);
  CHECK(open_error(ouster.uri("&port=1")).find("unknown option 'port'") != std::string::npos);
  CHECK(open_error(ouster.uri("&meta=" + meta)).find("packets in it: 1 of 48 bytes") != std::string::npos);
  TopicBag velodyne(kVelodyneType);
  velodyne.add(kNoon_ns, velodyne_message(kNoon_ns, {turning_packet(0, 0, 0x37, 0x28)}));
  CHECK(open_error(velodyne.uri("&model=VLP-16")).find("the packets are of another sensor (") !=
        std::string::npos);
  TopicBag livox("livox_ros_driver2/msg/CustomMsg");
  CHECK(open_error(livox.uri())
            .find("is of type livox_ros_driver2/msg/CustomMsg, which is not read (sensor_msgs") !=
        std::string::npos);
  TopicBag ros1("sensor_msgs/msg/PointCloud2", "ros1");
  CHECK(open_error(ros1.uri()).find("its messages are 'ros1', not CDR") != std::string::npos);
}

TEST_CASE("a bag's packets come as they were sent, at their own times, to be played") {
  TopicBag bag(kVelodyneType);
  const std::vector<ByteVector> packets{turning_packet(0), turning_packet(12)};
  bag.add(kNoon_ns, velodyne_message(kNoon_ns, packets, 1'000'000));
  ingest::SourceState state;
  const auto source = ingest::open_bag_packets(bag.uri(), state);
  REQUIRE(source.has_value());
  ingest::Packet packet;
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE((*source)->next(packet, std::chrono::milliseconds(0)).value() == ingest::PacketEvent::packet);
    CHECK(ByteVector(packet.data, packet.data + packet.size) == packets[i]);
    CHECK(packet.capture_ns == kNoon_ns + static_cast<std::int64_t>(i) * 1'000'000);
  }
  CHECK((*source)->next(packet, std::chrono::milliseconds(0)).value() == ingest::PacketEvent::end);
  TopicBag clouds("sensor_msgs/msg/PointCloud2");
  CHECK(ingest::open_bag_packets(clouds.uri(), state).error().find("has clouds, and no packets") !=
        std::string::npos);
}

TEST_CASE("a real bag gives the sweeps that its packets give as a pcap") {
  const auto data = recordings();
  if (!data) return;
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/a.pcap", 1, true);
  auto bag = bag::BagReader::open(*data + "/velodyne/vlp16_ros2.db3", {"/velodyne_packets"});
  REQUIRE(bag.has_value());
  bag::Message message;
  while (bag->next(message)) {
    ros::HeaderIn header;
    std::vector<ros::VelodynePacketIn> scan;
    REQUIRE(ros::read_velodyne_scan(message.data, header, scan).has_value());
    for (const auto& packet : scan)
      pcap.add(frame(ByteVector(packet.data, packet.data + 1206), {1, 2368, 1}), packet.stamp_ns);
  }
  const auto expected = all_sweeps(*open("velodyne:" + pcap.write() + "?model=VLP-16"));
  REQUIRE(expected.size() == 4);
  const auto source = open("bag:" + *data + "/velodyne/vlp16_ros2.db3?topic=/velodyne_packets&model=VLP-16");
  require_same(all_sweeps(*source), expected);
}
