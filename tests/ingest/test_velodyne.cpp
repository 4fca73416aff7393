// Velodyne packets built by hand: one laser at a known place, turns, times within the hour.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "services/ingest/hour_clock.hpp"
#include "services/ingest/velodyne_decoder.hpp"
#include "tests/ingest/frames_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

namespace {

constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr double kRadians = 3.14159265358979323846 / 180;

struct Shot {
  int azimuth = 0;  // 1/100 degree
  int laser = 0;    // 0 .. 31: the only measurement of the block that is not 0
  int range = 0;
};

ByteVector velodyne_packet(const std::vector<Shot>& blocks, std::uint32_t time_us, int mode = 0x37,
                           int product = 0x22) {
  ByteVector out;
  for (const Shot& shot : blocks) {
    append(out, {0xFF, 0xEE});
    put_le(out, static_cast<std::uint16_t>(shot.azimuth));
    for (int laser = 0; laser < 32; ++laser) {
      put_le(out, static_cast<std::uint16_t>(laser == shot.laser ? shot.range : 0));
      out.push_back(99);
    }
  }
  put_le(out, time_us);
  append(out, {static_cast<std::uint8_t>(mode), static_cast<std::uint8_t>(product)});
  return out;
}

/// A VLP-16 at 10 turns a second, 39.8 hundredths of a degree a block; every laser 0 returns at 2 m. Block
/// `n` counts from azimuth 0.
ByteVector turning_packet(int first_block, std::uint32_t start_us = 0, int mode = 0x37, int product = 0x22) {
  const int step = mode == 0x39 ? 2 : 1;
  std::vector<Shot> blocks;
  for (int i = 0; i < 12; ++i) blocks.push_back({(first_block + i / step) * 398 / 10 % 36000, 0, 1000});
  return velodyne_packet(blocks, start_us + static_cast<std::uint32_t>(std::lround(first_block * 110.592)),
                         mode, product);
}

struct Played {
  std::vector<Sweep> sweeps;
  SourceCounters counters;
  std::vector<std::string> warnings;
};

Played play(const std::vector<ByteVector>& packets, const std::string& model = "VLP-16",
            double min_fraction = 0.5, std::int64_t capture_ns = 0) {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/velodyne.pcap");
  for (const ByteVector& packet : packets) pcap.add(frame(packet, {1, 2368, 1}), capture_ns);
  auto source = open("velodyne:" + pcap.write() + "?model=" + model, {min_fraction, 200000});
  Played out;
  out.sweeps = all_sweeps(*source);
  out.counters = source->counters();
  out.warnings = source->warnings();
  return out;
}

/// The return of a packet whose blocks turn by `gap` and of which block 0 has one measurement.
Return one_return(const std::string& model, const Shot& shot, int gap, int product) {
  std::vector<Shot> blocks{shot};
  for (int i = 1; i < 12; ++i) blocks.push_back({shot.azimuth + i * gap, 0, 0});
  const auto played = play({velodyne_packet(blocks, 0, 0x37, product)}, model, 0.0);
  CHECK(played.warnings.empty());
  REQUIRE(played.sweeps.size() == 1);
  REQUIRE(played.sweeps[0].returns.size() == 1);
  return played.sweeps[0].returns[0];
}

void check_polar(const Return& r, double range_m, double azimuth_deg, double vertical_deg) {
  CHECK(r.x_m ==
        Approx(range_m * std::cos(vertical_deg * kRadians) * std::cos(azimuth_deg * kRadians)).margin(1e-9));
  CHECK(r.y_m ==
        Approx(-range_m * std::cos(vertical_deg * kRadians) * std::sin(azimuth_deg * kRadians)).margin(1e-9));
  CHECK(r.z_m == Approx(range_m * std::sin(vertical_deg * kRadians)).margin(1e-9));
}

std::vector<ByteVector> turn(int turns, std::uint32_t start_us = 0, int mode = 0x37, int product = 0x22) {
  std::vector<ByteVector> packets;
  const int step = mode == 0x39 ? 6 : 12;
  for (int block = 0; block < 905 * turns; block += step)
    packets.push_back(turning_packet(block, start_us, mode, product));
  return packets;
}

/// Packets whose blocks are flagged FFEE, FFDD ...: a cycle of `banks`.
std::vector<ByteVector> flagged(std::vector<ByteVector> packets, std::size_t banks) {
  constexpr std::uint8_t kFlags[4] = {0xEE, 0xDD, 0xCC, 0xBB};
  for (ByteVector& packet : packets)
    for (std::size_t block = 0; block < 12; ++block) packet[block * 100 + 1] = kFlags[block % banks];
  return packets;
}

std::string refusal(const std::vector<ByteVector>& packets, const std::string& model) {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/velodyne.pcap");
  for (const ByteVector& packet : packets) pcap.add(frame(packet, {1, 2368, 1}));
  return open_error("velodyne:" + pcap.write() + "?model=" + model);
}

void check_refused(const std::vector<ByteVector>& packets, const std::string& model, const std::string& why) {
  const std::string error = refusal(packets, model);
  INFO(model << ": " << error);
  CHECK(error.find("velodyne.pcap: the packets are of another sensor (" + why + ")") != std::string::npos);
  CHECK(error.find("the source says " + model.substr(0, model.find('&')) + ": packets of") !=
        std::string::npos);
}

}  // namespace

TEST_CASE("azimuth 0 is forward, 90 degrees is right") {
  check_polar(one_return("VLP-16", {0, 0, 5000}, 0, 0x22), 10, 0, -15);
  check_polar(one_return("VLP-16", {9000, 1, 5000}, 0, 0x22), 10, 90, 1);
  CHECK(one_return("VLP-16", {9000, 1, 5000}, 0, 0x22).y_m < -9.9);
}

TEST_CASE("a laser that fires later in the block points further on") {
  // VLP-16: measurement 31 is laser 15 of the second firing: 55.296 + 15 * 2.304 of 110.592 us.
  check_polar(one_return("VLP-16", {1000, 31, 5000}, 40, 0x22), 10, 10 + 0.4 * (55.296 + 34.56) / 110.592,
              15);
  // HDL-32: laser 31 of 32, 1.152 us each, blocks of 46.08 us.
  check_polar(one_return("HDL-32", {1000, 31, 5000}, 20, 0x21), 10, 10 + 0.2 * 31 * 1.152 / 46.08, 10.67);
  // VLP-32C: lasers fire in pairs; 4 mm units; laser 2 is 1.4 degrees ahead, laser 3 is as much behind.
  check_polar(one_return("VLP-32C", {1000, 2, 5000}, 20, 0x28), 20, 10 + 0.2 * 2.304 / 55.296 + 1.4, -1.667);
  check_polar(one_return("VLP-32C", {1000, 3, 5000}, 20, 0x28), 20, 10 + 0.2 * 2.304 / 55.296 - 1.4, -15.639);
}

TEST_CASE("sweeps are cut where the azimuth passes through 0; a whole turn is complete") {
  const auto played = play(turn(3));
  REQUIRE(played.sweeps.size() == 3);
  CHECK(played.sweeps[0].complete);
  CHECK(played.sweeps[1].complete);
  CHECK(played.sweeps[1].returns.size() == Approx(904.5).margin(0.6));
  CHECK(played.sweeps[1].times_ns.front() - played.sweeps[0].times_ns.back() ==
        Approx(110592 / 2).margin(1000));
}

TEST_CASE("a missing packet makes a turn incomplete") {
  auto packets = turn(2);
  packets.erase(packets.begin() + 30);
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 2);
  CHECK_FALSE(played.sweeps[0].complete);
  CHECK(played.sweeps[0].columns_seen_fraction == Approx(1 - 12 / 904.5).margin(0.002));
  CHECK(played.sweeps[0].returns.size() == Approx(904.5 - 12).margin(0.6));
  CHECK(played.sweeps[1].complete);
  CHECK(played.sweeps[1].columns_seen_fraction == 1);
}

TEST_CASE("less than half a turn is dropped") {
  auto packets = turn(1);
  packets.resize(packets.size() * 2 / 5);
  const auto played = play(packets);
  CHECK(played.sweeps.empty());
  CHECK(played.counters.dropped_sweeps == 1);
}

TEST_CASE("a packet out of order is used, one that comes twice is not, one of the turn before is late") {
  auto packets = turn(2);
  std::swap(packets[10], packets[11]);
  packets.insert(packets.begin() + 20, packets[19]);
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 2);
  CHECK(played.sweeps[0].complete);
  CHECK(played.sweeps[0].returns.size() == Approx(904.5).margin(0.6));
  CHECK(played.counters.out_of_order_packets == 1);
  CHECK(played.counters.duplicate_packets == 1);

  packets = turn(2);
  const ByteVector delayed = packets[50];
  packets.erase(packets.begin() + 50);
  packets.insert(packets.begin() + 80, delayed);
  CHECK(play(packets).counters.late_packets == 1);
}

TEST_CASE("dual return mode: pairs of blocks are one shot; the second counts if it differs") {
  std::vector<Shot> blocks;
  for (int pair = 0; pair < 6; ++pair) {
    blocks.push_back({1000 + pair * 40, 1, 5000});
    blocks.push_back({1000 + pair * 40, 1, pair == 0 ? 6000 : pair == 1 ? 0 : 5000});
  }
  const auto played = play({velodyne_packet(blocks, 0, 0x39)}, "VLP-16", 0.0);
  REQUIRE(played.sweeps.size() == 1);
  REQUIRE(played.sweeps[0].returns.size() == 7);
  CHECK(played.sweeps[0].times_ns.size() == 12);
  check_polar(played.sweeps[0].returns[0], 10, 10 + 0.4 * 2.304 / 110.592, 1);
  check_polar(played.sweeps[0].returns[1], 12, 10 + 0.4 * 2.304 / 110.592, 1);
  CHECK(played.sweeps[0].returns[0].time_index == played.sweeps[0].returns[1].time_index);
  CHECK(played.sweeps[0].times_ns[2] - played.sweeps[0].times_ns[0] == 110592);
}

TEST_CASE("the hour is the capture's, also around the full hour") {
  const std::int64_t hour = 400'000 * kHourNs;
  const auto before = play(turn(1, 3'599'950'000), "VLP-16", 0.5, hour + 2'000'000'000);
  // The count of packets goes on past the hour here; a sensor's starts again.
  REQUIRE_FALSE(before.sweeps.empty());
  CHECK(before.sweeps[0].times_ns.front() == hour - 50'000'000);

  std::vector<ByteVector> packets;
  for (int block = 0; block < 905; block += 12) {
    const auto us = (3'599'950'000 + std::llround(block * 110.592)) % 3'600'000'000;
    ByteVector packet = turning_packet(block);
    const auto time_us = static_cast<std::uint32_t>(us);
    std::memcpy(packet.data() + 1200, &time_us, 4);
    packets.push_back(packet);
  }
  const auto across = play(packets, "VLP-16", 0.5, hour);
  REQUIRE(across.sweeps.size() == 1);
  CHECK(across.sweeps[0].complete);
  CHECK(across.sweeps[0].times_ns.front() == hour - 50'000'000);
  CHECK(across.sweeps[0].stamp_ns == Approx(hour + 50'000'000).margin(200'000));
}

TEST_CASE("live, the hour comes from the hint, and a hint that contradicts it changes it") {
  HourClock clock;
  CHECK(clock.full_time_ns(5, 0, 1000) == 5);
  CHECK(clock.is_hour_unknown());
  clock.hint(77 * kHourNs + 1'000'000'000);
  CHECK_FALSE(clock.is_hour_unknown());
  CHECK(clock.full_time_ns(1005, 0, 2000) == 77 * kHourNs + 1005);
  clock.hint(77 * kHourNs - 1'000'000'000);
  CHECK(clock.full_time_ns(2005, 0, 3000) == 77 * kHourNs + 2005);
  clock.hint(5 * kHourNs);
  CHECK(clock.full_time_ns(3005, 0, 4000) == 5 * kHourNs + 3005);
  // An hour and a second later, by this machine's clock.
  CHECK(clock.full_time_ns(1'000'003'005, 0, kHourNs + 1'000'004'000) == 6 * kHourNs + 1'000'003'005);
}

TEST_CASE("packets that are not of the sensor are foreign; blocks that are broken are counted") {
  auto packets = turn(1);
  packets[3][0] = 0;                                 // no block flag
  packets.insert(packets.begin(), ByteVector(512));  // a position packet
  packets[10][100] = 0;                              // no flag of the second block
  packets[11][3] = 0xFF;                             // an azimuth of 652 degrees
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 1);
  CHECK(played.counters.foreign_packets == 2);
  CHECK(played.counters.invalid_columns == 2);
  CHECK(played.sweeps[0].returns.size() == 904 + 1 - 12 - 2);
}

TEST_CASE("a recording that is played again and again is taken up again") {
  auto packets = turn(1);
  const auto again = packets;
  for (int i = 0; i < 3; ++i) packets.insert(packets.end(), again.begin(), again.end());
  const auto played = play(packets);
  CHECK(played.sweeps.size() == 4);
  CHECK(played.counters.packets == packets.size());
}

TEST_CASE("packets of another model are refused, naming what they are") {
  check_refused(turn(1, 0, 0x37, 0x21), "VLP-16", "an HDL-32, model byte 0x21");
  check_refused(turn(1, 0, 0x37, 0x24), "VLP-16", "a Puck Hi-Res, model byte 0x24");
  check_refused(turn(1, 0, 0x39, 0x22), "VLP-32C", "a VLP-16, model byte 0x22");
  check_refused(turn(1, 0, 0x38, 0x28), "HDL-32", "a VLP-32C, model byte 0x28");
  check_refused(turn(1, 0, 0x37, 0x77), "VLP-16", "no sensor that is known, model byte 0x77");
  for (const char* model : {"VLP-16", "VLP-32C", "HDL-32"}) {
    check_refused(flagged(turn(1, 0, 0x37, 0xA1), 4), model, "a VLS-128, model byte 0xA1");
    check_refused(flagged(turn(1, 0, 0x37, 0x22), 2), model, "an HDL-64E, blocks DDFF");
  }
}

TEST_CASE("block flags prove a model whatever the byte says; a return mode that is not known is refused") {
  check_refused(flagged(turn(1), 4), "VLP-16", "a VLS-128, blocks BBFF, but model byte 0x22");
  CHECK(refusal(flagged(turn(1), 4), "VLP-16").find("model_byte=") == std::string::npos);  // would not help
  check_refused(turn(1, 0, 0x3A), "VLP-16", "return mode 0x3A, neither 0x37, 0x38 nor 0x39");
  check_refused(turn(1, 0, 0x00), "VLP-16", "return mode 0x00, neither 0x37, 0x38 nor 0x39");
}

TEST_CASE("a wrong model byte is taken where the source names it") {
  const auto packets = turn(2, 0, 0x37, 0x21);
  CHECK(refusal(packets, "VLP-16").find("model_byte=0x21") != std::string::npos);
  const auto played = play(packets, "VLP-16&model_byte=0x21");
  CHECK(played.sweeps.size() == 2);
  CHECK(played.warnings.empty());
  CHECK(play(packets, "VLP-16&model_byte=33").sweeps.size() == 2);
  check_refused(turn(1), "VLP-16&model_byte=0x21", "a VLP-16, model byte 0x22");
  CHECK(refusal(packets, "VLP-16&model_byte=0x100").find("model_byte '0x100' is not a whole number") !=
        std::string::npos);
}

TEST_CASE("packets of firmware without mode and model byte are read as the source says") {
  const auto single = turn(2, 0, 0x00, 0x00);
  CHECK(refusal(single, "VLP-16").find("model_byte=0x00&returns=single (or dual)") != std::string::npos);
  CHECK(play(single, "VLP-16&model_byte=0x00&returns=single").sweeps.size() == 2);
  std::vector<ByteVector> dual = turn(2, 0, 0x39, 0x22);
  for (ByteVector& packet : dual) packet[1204] = 0;
  const auto read = play(dual, "VLP-16&returns=dual");
  const auto told = play(turn(2, 0, 0x39, 0x22));
  REQUIRE(read.sweeps.size() == 2);
  CHECK(read.sweeps[0].returns.size() == told.sweeps[0].returns.size());
  CHECK(refusal(dual, "VLP-16&returns=both").find("returns 'both' is not single or dual") !=
        std::string::npos);
}

TEST_CASE("of two models in one recording, the one that is asked for is mapped, and the other is told of") {
  const auto ours = turn(2);
  const auto others = flagged(turn(2, 0, 0x37, 0xA1), 4);
  std::vector<ByteVector> mixed{others[0], others[1]};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    mixed.push_back(ours[i]);
    mixed.push_back(others[i]);
  }
  const auto played = play(mixed);
  const auto alone = play(ours);
  REQUIRE(played.sweeps.size() == alone.sweeps.size());
  CHECK(played.sweeps[0].returns.size() == alone.sweeps[0].returns.size());
  CHECK(played.counters.foreign_packets == others.size() + 2);
  REQUIRE(played.warnings.size() == 1);
  CHECK(played.warnings[0].find("packets of another sensor (a VLS-128, model byte 0xA1) come too") == 0);
}

TEST_CASE("VLS-128: four banks of one azimuth are a sequence; each laser has its angles and its moment") {
  // Laser 69, the sixth of the third bank, fires in the ninth group, one slot later for the pause: 9 of 20.
  std::vector<Shot> blocks(12);
  for (int i = 0; i < 12; ++i)
    blocks[static_cast<std::size_t>(i)] = {1000 + 20 * (i / 4), 5, i == 6 ? 2500 : 0};
  const auto packets = flagged({velodyne_packet(blocks, 0, 0x37, 0xA1)}, 4);
  const auto played = play(packets, "VLS-128", 0.0);
  REQUIRE(played.sweeps.size() == 1);
  REQUIRE(played.sweeps[0].returns.size() == 1);
  check_polar(played.sweeps[0].returns[0], 10, 10.2 + 0.2 * 9 / 20 - 2.732, -19.582);
  REQUIRE(played.sweeps[0].times_ns.size() == 3);
  CHECK(played.sweeps[0].returns[0].time_index == 1);
  CHECK(played.sweeps[0].times_ns[1] - played.sweeps[0].times_ns[0] == 53300);
  CHECK(played.counters.invalid_columns == 0);
}

TEST_CASE("VLS-128 in dual return mode: eight blocks are a sequence, the last four of a packet are padding") {
  std::vector<ByteVector> packets;
  for (int i = 0; i < 1900; ++i) {  // 0.2 degrees a sequence
    std::vector<Shot> blocks(12, Shot{0, 0, 0});
    for (std::size_t k = 0; k < 8; ++k) blocks[k] = {i * 20 % 36000, 7, k % 2 == 0 ? 1000 : 1500};
    ByteVector packet = velodyne_packet(blocks, static_cast<std::uint32_t>(i * 53.3), 0x39, 0xA1);
    for (std::size_t k = 0; k < 12; ++k)
      packet[k * 100 + 1] = k < 8 ? static_cast<std::uint8_t>(0xEE - 0x11 * (k / 2)) : 0;
    packets.push_back(packet);
  }
  const auto played = play(packets, "VLS-128");
  REQUIRE(played.sweeps.size() == 1);
  CHECK(played.sweeps[0].complete);
  CHECK(played.sweeps[0].returns.size() == 1800 * 8);
  CHECK(played.counters.invalid_columns == 0);
  // Laser 39, of the second bank, fires fifth: its slot is 4 of 20.
  check_polar(played.sweeps[0].returns[1000 * 8 + 2], 4, 200 + 0.2 * 4 / 20 - 6.354, -5.73);
  CHECK(played.sweeps[0].returns[1000 * 8 + 7].time_index == 1000);
}

TEST_CASE("Puck Hi-Res: a VLP-16 whose lasers are 1.33 degrees apart") {
  check_polar(one_return("Puck-Hi-Res", {9000, 0, 5000}, 0, 0x24), 10, 90, -10);
  check_polar(one_return("Puck-Hi-Res", {1000, 31, 5000}, 40, 0x24), 10,
              10 + 0.4 * (55.296 + 34.56) / 110.592, 10);
}

TEST_CASE("VLP-32C: the table is that of a cloud that another decoder made") {
  const auto data = recordings();
  if (!data) return;
  std::ifstream file(*data + "/rellis_offroad/vlp32.bin", std::ios::binary);
  std::vector<float> p(4);
  const auto& lasers = find_velodyne_model("VLP-32C")->lasers;
  std::vector<int> returns(32);
  std::size_t last = 31;
  double firing_deg = 0, worst_deg = 0, worst_m = 0;
  int strays = 0;  // a firing that begins behind the laser with which the one before ended
  while (file.read(reinterpret_cast<char*>(p.data()), 16)) {
    const double range = std::hypot(p[0], p[1], p[2]);
    if (range < 0.5) continue;
    const double vertical = std::asin(p[2] / range) / kRadians;
    const auto laser = static_cast<std::size_t>(
        std::min_element(lasers.begin(), lasers.end(),
                         [&](const VelodyneLaser& a, const VelodyneLaser& b) {
                           return std::abs(a.vertical_deg - vertical) < std::abs(b.vertical_deg - vertical);
                         }) -
        lasers.begin());
    worst_deg = std::max(worst_deg, std::abs(lasers[laser].vertical_deg - vertical));
    worst_m = std::max(worst_m, std::abs(std::remainder(range, 0.004)));
    // Points are in the order of the table, and that decoder leaves the azimuth of a firing alone.
    const double turned_deg = std::atan2(-p[1], p[0]) / kRadians - lasers[laser].azimuth_deg;
    if (laser > last && std::abs(std::remainder(turned_deg - firing_deg, 360)) > 1e-3) ++strays;
    firing_deg = turned_deg;
    last = laser;
    ++returns[laser];
  }
  CHECK(worst_deg < 1e-3);
  CHECK(worst_m < 1e-4);
  CHECK(strays < 5);
  for (const int count : returns) CHECK(count > 200);
}

TEST_CASE("a model that was taken on trust is not, where packets come at another pace than its") {
  // VLP-16 packets, each 1327 us, as those of an HDL-32, each 553 us; and the other way round.
  const auto slow = play(turn(3), "HDL-32&model_byte=0x22");
  CHECK(slow.sweeps.empty());
  CHECK(slow.counters.misfit_sweeps == 4);  // and what is behind the third turn
  REQUIRE(!slow.warnings.empty());
  CHECK(slow.warnings[0].find(
            "a packet comes each 1327 us, one of model HDL-32 in this return mode each 553") == 0);
  std::vector<ByteVector> fast = turn(3);
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const auto time_us = static_cast<std::uint32_t>(i * 553);
    std::memcpy(fast[i].data() + 1200, &time_us, 4);
  }
  CHECK(play(fast, "VLP-16").sweeps.empty());
  CHECK(play(turn(3), "VLP-16&returns=dual").sweeps.empty());  // six shots a packet would take half the time
}

TEST_CASE("lost packets and some out of order are no other pace") {
  auto packets = turn(6);
  for (std::size_t i = 10; i + 4 < packets.size(); i += 9) std::swap(packets[i], packets[i + 1]);
  std::vector<ByteVector> some;
  for (std::size_t i = 0; i < packets.size(); ++i)
    if (i % 10 >= 4) some.push_back(packets[i]);
  const auto played = play(some);
  CHECK(played.sweeps.size() == 6);
  CHECK(played.warnings.empty());
}
