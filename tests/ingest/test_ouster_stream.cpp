// Packets out of order, twice, too late, of others: what is used, what is counted, where sweeps are cut.
#include "tests/ingest/ouster_stream.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceCounters;

TEST_CASE("frames become sweeps; the stamp is the time of the last return") {
  Stream stream;
  const auto sweeps = stream.whole_frame(1).whole_frame(2).play();
  REQUIRE(sweeps.size() == 2);
  CHECK(sweeps[0].returns.size() == 32);
  CHECK(sweeps[0].times_ns.size() == 16);
  CHECK(sweeps[0].complete);
  CHECK(sweeps[1].stamp_ns == column_time_ns(2, 15));
  CHECK(stream.counters().packets == 8);
  CHECK(stream.counters().sweeps == 2);
}

TEST_CASE(
    "columns without returns at the end do not move the stamp; without any return it is the last column's") {
  Stream stream;
  const OusterSensor& sensor = stream.sensor();
  for (int column = 0; column < 16; column += 4) {
    stream.raw(frame(plain_packet(sensor, 1, column, column < 8 ? 5000 : 0)));
  }
  for (int column = 0; column < 16; column += 4) stream.raw(frame(plain_packet(sensor, 2, column, 0)));
  const auto sweeps = stream.play();
  REQUIRE(sweeps.size() == 2);
  CHECK(sweeps[0].stamp_ns == column_time_ns(1, 7));
  CHECK(sweeps[1].returns.empty());
  CHECK(sweeps[1].stamp_ns == column_time_ns(2, 15));
}

TEST_CASE("the frame id wraps") {
  Stream stream;
  CHECK(stream.whole_frame(65535).whole_frame(0).play().size() == 2);
  CHECK(stream.counters().foreign_packets == 0);
}

TEST_CASE("a packet out of order within its frame is used") {
  Stream stream;
  const auto sweeps = stream.packet(1, 0).packet(1, 8).packet(1, 4).packet(1, 12).play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].complete);
  CHECK(sweeps[0].returns.size() == 32);
  CHECK(stream.counters().out_of_order_packets == 1);
}

TEST_CASE("a packet that comes twice is used once, also the last one of a frame") {
  Stream stream;
  const auto sweeps =
      stream.packet(1, 0).packet(1, 0).packet(1, 4).packet(1, 8).packet(1, 12).packet(1, 12).play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 32);
  CHECK(stream.counters().duplicate_packets == 2);
}

TEST_CASE("a packet of the frame before is late") {
  Stream stream;
  const auto sweeps = stream.packet(1, 0)
                          .packet(1, 4)
                          .packet(1, 12)
                          .packet(2, 0)
                          .packet(1, 8)
                          .packet(2, 4)
                          .packet(2, 8)
                          .packet(2, 12)
                          .play();
  REQUIRE(sweeps.size() == 2);
  CHECK_FALSE(sweeps[0].complete);
  CHECK(sweeps[0].columns_seen_fraction == 0.75);
  CHECK(sweeps[0].returns.size() == 24);
  CHECK(sweeps[1].complete);
  CHECK(sweeps[1].columns_seen_fraction == 1);
  CHECK(stream.counters().late_packets == 1);
  CHECK(stream.counters().incomplete_sweeps == 1);
}

TEST_CASE("under min_sweep_fraction a sweep is dropped, at it it is kept") {
  Stream stream;
  const auto sweeps = stream.packet(1, 0).packet(2, 0).packet(2, 4).whole_frame(3).play(0.5);
  REQUIRE(sweeps.size() == 2);
  CHECK(sweeps[0].returns.size() == 16);
  CHECK(stream.counters().dropped_sweeps == 1);
  CHECK(stream.counters().incomplete_sweeps == 1);
}

TEST_CASE("a column window is all that is expected, also one that wraps") {
  OusterSensor sensor;
  sensor.window = "[12, 3]";
  Stream stream(sensor);
  const auto sweeps = stream.packet(1, 0).packet(1, 12).packet(2, 0).packet(2, 12).play();
  REQUIRE(sweeps.size() == 2);
  CHECK(sweeps[0].complete);
}

TEST_CASE("columns that are not valid or not in the window are counted") {
  OusterSensor sensor;
  sensor.profile = "RNG19_RFL8_SIG16_NIR16";
  sensor.window = "[0, 7]";
  Stream stream(sensor);
  std::vector<Column> columns = {
      {0, {1000, 1000}}, {1, {1000, 1000}, {}, false}, {9, {1000, 1000}}, {60000, {1, 1}}};
  const auto sweeps = stream.raw(frame(ouster_packet(sensor, 1, columns))).play(0.0);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 2);
  CHECK_FALSE(sweeps[0].complete);
  CHECK(stream.counters().invalid_columns == 3);
}

TEST_CASE("a column whose time is damaged is not used, and the sweep keeps its own") {
  for (const int damaged : {1, 2}) {
    Stream stream{OusterSensor{}};
    for (int column = 0; column < 16; column += 4) {
      ByteVector packet = plain_packet({}, 1, column);
      constexpr std::size_t kColumnBytes = 16 + 2 * 12 + 4;
      if (column == 8)
        packet.at(static_cast<std::size_t>(damaged) * kColumnBytes + 4) ^= 0x02;  // 8.6 s later
      stream.raw(frame(packet));
    }
    const auto sweeps = stream.play(0.0);
    REQUIRE(sweeps.size() == 1);
    CHECK(sweeps[0].stamp_ns == OusterSensor{}.column_time_ns(1, 15));
    CHECK(sweeps[0].returns.size() == 30);
    CHECK(stream.counters().invalid_columns == 1);
  }
}

TEST_CASE("whole turns and metadata of a slice: what is outside is not used, and told") {
  OusterSensor sensor;
  sensor.window = "[0, 9]";
  Stream stream(sensor);
  stream.whole_frame(1).whole_frame(2).play();
  CHECK(stream.counters().foreign_packets ==
        2);  // of columns 12 .. 15; at the edge, columns are invalid ones
  CHECK(stream.counters().invalid_columns == 4);
  REQUIRE(!stream.warnings().empty());
  CHECK(stream.warnings()[0].find("column 12, the metadata's window is 0 .. 9") != std::string::npos);
}

TEST_CASE("another size, another sender, another protocol, a far frame: foreign, and the sweep is whole") {
  Stream stream;
  stream.packet(1, 0).packet(1, 4);
  stream.raw(frame(ByteVector(48)));  // an IMU packet
  stream.packet(1, 8, {2, 7502, 1});  // another sensor
  stream.raw(ByteVector(60, 0));      // no IP
  stream.packet(20000, 0);            // a frame of another time
  const auto sweeps = stream.packet(1, 8).packet(1, 12).play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].complete);
  CHECK(sweeps[0].returns.size() == 32);
  CHECK(stream.counters().foreign_packets == 3);
  CHECK(stream.counters().second_sensor_packets == 1);
}

TEST_CASE("packets to other ports are foreign if a port is asked for") {
  Stream stream;
  const auto sweeps = stream.whole_frame(9, {1, 7000, 1}).whole_frame(1).play(0.5, 1000, "&port=7502");
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].stamp_ns == column_time_ns(1, 15));
  CHECK(stream.counters().foreign_packets == 4);
}

TEST_CASE("a stream that starts again is taken up again: a reboot, a looped recording") {
  Stream stream;
  stream.whole_frame(20000).whole_frame(20001);
  for (int id = 1; id <= 4; ++id) stream.whole_frame(id);  // a new numbering
  for (int id = 1; id <= 4; ++id) stream.whole_frame(id);  // the same again
  const auto sweeps = stream.play();
  // Of each beginning, seven packets tell that it is one: four of the first frame, three of the second. The
  // eighth is used, but is not enough of a sweep.
  CHECK(sweeps.size() == 2 + 2 + 2);
  CHECK(stream.counters().foreign_packets == 7);
  CHECK(stream.counters().late_packets == 7);
  CHECK(stream.counters().dropped_sweeps == 2);
}

TEST_CASE("a sensor that got another address is taken up again") {
  Stream stream;
  const auto sweeps = stream.whole_frame(1)
                          .whole_frame(2, {9, 7502, 1})
                          .whole_frame(3, {9, 7502, 1})
                          .whole_frame(4, {9, 7502, 1})
                          .play();
  CHECK(sweeps.size() == 2);
  CHECK(stream.counters().second_sensor_packets == 8);
}

TEST_CASE("a frame's packets that come ten times over are duplicates, and no stream that starts again") {
  Stream stream;
  for (int frame = 1; frame <= 3; ++frame) {
    stream.whole_frame(frame);
    for (int copy = 0; copy < 9; ++copy) stream.packet(frame, 12);
  }
  CHECK(stream.play().size() == 3);
  CHECK(stream.counters().duplicate_packets == 27);
  CHECK(stream.counters().dropped_sweeps == 0);
}

TEST_CASE("columns that never came are counted, of whole frames too, but not before the first whole frame") {
  Stream stream;
  stream.packet(1, 8).packet(1, 12);  // began within the frame
  stream.packet(2, 0).packet(2, 4).packet(2, 12);
  stream.whole_frame(4);
  stream.whole_frame(20);  // after a silence
  stream.play();
  CHECK(stream.counters().columns == 8 + 12 + 16 + 16);
  CHECK(stream.counters().missing_columns == 4 + 16);
}

TEST_CASE("returns beyond max_returns are counted, and the sweep is what fits") {
  Stream stream;
  const auto sweeps = stream.whole_frame(1).play(0.5, 20);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 20);
  CHECK(stream.counters().overflow_returns == 12);
  CHECK(sweeps[0].stamp_ns == column_time_ns(1, 9));
}

TEST_CASE("fragmented packets are put together, in any order; one that stays in pieces is lost and counted") {
  Stream stream;
  stream.packet(1, 0);
  auto parts = fragments(plain_packet(stream.sensor(), 1, 4), 64, {1, 7502, 42});
  REQUIRE(parts.size() > 2);
  std::swap(parts.front(), parts.back());
  for (const auto& part : parts) stream.raw(part);
  stream.packet(1, 8);
  auto incomplete = fragments(plain_packet(stream.sensor(), 1, 12), 64, {1, 7502, 43});
  incomplete.erase(incomplete.begin() + 1);
  for (const auto& part : incomplete) stream.raw(part);
  const auto sweeps = stream.play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 24);
  CHECK(stream.counters().fragments == parts.size() + incomplete.size());
  CHECK(stream.counters().lost_fragments == 1);
}

TEST_CASE("packets that were captured in part are counted") {
  Stream stream;
  stream.raw(frame(plain_packet(stream.sensor(), 1, 0)), 10);
  const auto sweeps = stream.packet(1, 4).packet(1, 8).packet(1, 12).play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 24);
  CHECK(stream.counters().truncated_packets == 1);
}
