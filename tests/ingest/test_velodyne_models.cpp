// Which Velodyne the packets are of: marks that prove it, the models' tables, the pace.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "services/ingest/velodyne_model.hpp"
#include "tests/ingest/velodyne_builder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

namespace {

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
