// Which Ouster the packets are of, and of which mode: serial numbers, columns, turns.
#include <algorithm>

#include "tests/ingest/ouster_stream.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

OusterSensor with_serial(std::uint64_t serial) {
  OusterSensor sensor;
  sensor.profile = "RNG19_RFL8_SIG16_NIR16";
  sensor.serial = serial;
  return sensor;
}

}  // namespace

TEST_CASE("packets of another serial number than the metadata's are refused, naming both") {
  Stream stream(with_serial(122201000998));
  stream.whole_frame(1);
  const std::string error = stream.refusal(with_serial(992210000957));
  INFO(error);
  CHECK(error.find("the packets are of another sensor (serial number 122201000998, the metadata is of "
                   "992210000957)") != std::string::npos);
  CHECK(error.find("serial=122201000998") != std::string::npos);
}

TEST_CASE("a serial number that is given in the source is the one that packets must have") {
  Stream stream(with_serial(5));
  const auto sweeps = stream.whole_frame(1).play(0.5, 1000, "&serial=5");
  CHECK(sweeps.size() == 1);
  OusterSensor other = with_serial(6);
  Stream replaced(with_serial(7));
  for (int column = 0; column < 16; column += 4) replaced.raw(frame(plain_packet(other, 1, column)));
  CHECK(replaced.play(0.5, 1000, "&serial=6").size() == 1);
}

TEST_CASE("of two sensors behind one address, the one of the metadata is mapped, and the other is told of") {
  Stream stream(with_serial(5));
  const OusterSensor other = with_serial(6);
  for (int column = 0; column < 16; column += 4) {
    stream.raw(frame(plain_packet(other, 9, column, 7000)));
    stream.packet(1, column);
  }
  const auto sweeps = stream.play();
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].complete);
  CHECK(sweeps[0].returns.size() == 32);
  CHECK(stream.counters().second_sensor_packets == 4);
  REQUIRE(stream.warnings().size() == 1);
  CHECK(stream.warnings()[0].find("serial number 6, the metadata is of 5") != std::string::npos);
}

TEST_CASE("a functional-safety header has its own place for frame and serial number") {
  OusterSensor sensor = with_serial(122246000293);
  sensor.profile = "FUSA_RNG15_RFL8_NIR8_DUAL";
  Stream stream(sensor);
  CHECK(stream.whole_frame(65535).whole_frame(65536).play().size() == 2);  // 32 bits
  CHECK(stream.counters().second_sensor_packets == 0);
  OusterSensor other = sensor;
  other.serial = 5;
  CHECK(stream.refusal(other).find("serial number 122246000293, the metadata is of 5") != std::string::npos);
}

TEST_CASE(
    "packets of another mode than the metadata's are refused: columns of the encoder, of time, beyond the "
    "frame") {
  OusterSensor meta;  // 16 columns a turn
  OusterSensor twice;
  twice.encoder_step = 90112 / 32;
  Stream encoder(twice);
  CHECK(encoder.whole_frame(1).refusal(meta).find("32 columns a turn, the metadata has 16") !=
        std::string::npos);

  OusterSensor timed = with_serial(5);
  timed.mode = "16x10";
  timed.column_ns = 100'000'000 / 8;
  Stream half(timed);
  CHECK(half.whole_frame(1).refusal(timed).find("a column each 12500 us, 6250 in the metadata's mode") !=
        std::string::npos);
  timed.column_ns = 100'000'000 / 16;
  CHECK(Stream(timed).whole_frame(1).play().size() == 1);

  OusterSensor slice = with_serial(5);
  slice.window = "[0, 7]";
  Stream outside(with_serial(5));
  outside.packet(1, 8).packet(1, 12);
  CHECK(outside.refusal(slice).find("column 8, the metadata's window is 0 .. 7") != std::string::npos);
  slice.window = "[12, 3]";
  Stream wraps(with_serial(5));
  wraps.packet(1, 4).packet(1, 8);
  CHECK(wraps.refusal(slice).find("column 4, the metadata's window is 12 .. 3") != std::string::npos);

  Stream beyond(with_serial(5));
  beyond.packet(1, 16).packet(1, 20);
  CHECK(beyond.refusal(with_serial(5)).find("column 19, the metadata has 16 a turn") != std::string::npos);
}

TEST_CASE("half a turn is no turn where the sensor has twice the columns in twice the time") {
  OusterSensor sensor = with_serial(5);
  sensor.mode = "16x20";
  sensor.column_ns = 50'000'000 / 16;
  sensor.frame_ns = 100'000'000;  // of 32 columns
  Stream stream(sensor);
  for (int frame = 1; frame <= 6; ++frame)
    for (int column = 0; column < 32; column += 4) stream.packet(frame, column);
  CHECK(stream.play().size() == 1);  // the first: nothing was known yet
  CHECK(stream.counters().misfit_sweeps == 5);
  const auto& warnings = stream.warnings();
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("a turn takes longer than in the metadata's mode, 1/20 s") == 0;
  }));

  OusterSensor right = sensor;
  right.frame_ns = 50'000'000;
  Stream lossy(right);  // whole turns, but for two that are lost, and the beginnings of others
  for (int frame = 1; frame <= 8; ++frame)
    if (frame != 3 && frame != 4)
      for (int column = frame % 2 * 8; column < 16; column += 4) lossy.packet(frame, column);
  CHECK(lossy.play(0.4).size() == 6);
  CHECK(lossy.counters().misfit_sweeps == 0);
}

TEST_CASE("turns of half the columns in half the time are not mapped as halves of a turn") {
  OusterSensor sensor = with_serial(5);
  sensor.mode = "16x10";
  sensor.column_ns = 100'000'000 / 16;
  sensor.frame_ns = 50'000'000;  // of 8 columns
  Stream stream(sensor);
  for (int frame = 1; frame <= 6; ++frame) stream.packet(frame, 0).packet(frame, 4);
  CHECK(stream.play(0.6).empty());
  Stream half(sensor);
  for (int frame = 1; frame <= 6; ++frame) half.packet(frame, 0).packet(frame, 4);
  half.play(0.5);
  CHECK(half.counters().misfit_sweeps == 6);
  CHECK(half.counters().dropped_sweeps == 0);
  CHECK(half.counters().sweeps == 0);
  REQUIRE(half.warnings().size() == 2);
  CHECK(half.warnings()[0].find("turns end with column 7, the metadata has 16") == 0);
  CHECK(half.warnings()[1].find("no sweep came of 12 packets: 6 sweeps of another mode or pace than") == 0);

  OusterSensor lossy = sensor;  // whole turns, of which the second half is lost
  lossy.frame_ns = 100'000'000;
  Stream lost(lossy);
  for (int frame = 1; frame <= 6; ++frame) lost.packet(frame, 0).packet(frame, 4);
  CHECK(lost.play(0.5).size() == 6);
}
