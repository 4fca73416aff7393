// HDL-64E: its calibration file, and what becomes of packets with it.
#include <cmath>

#include "services/ingest/velodyne_calibration.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

/// A calibration of 64 lasers from 2 degrees up to 29.5 down; laser 40 has `keys` in place of no correction.
std::string calibration(const std::string& keys = "rot_correction: 0.0, dist_correction: 0.0") {
  std::string text = "num_lasers: 64\nlasers:\n";
  for (int i = 0; i < 64; ++i) {
    text += "- {laser_id: " + std::to_string(i) +
            ", vert_correction: " + std::to_string((2 - 0.5 * i) * kRadians) + ", " +
            (i == 40 ? keys : "rot_correction: 0.0, dist_correction: 0.0") + "}\n";
  }
  return text;
}

/// `text` with its first `from` made `to`.
std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string error_of(const std::string& text) {
  TemporaryFolder folder;
  const auto model = ingest::read_velodyne_calibration(write_text(folder.path() + "/db.yaml", text));
  REQUIRE_FALSE(model.has_value());
  return model.error();
}

void check_error(const std::string& text, const std::string& part) {
  const std::string error = error_of(text);
  INFO(error);
  CHECK(error.find(part) != std::string::npos);
}

/// Six sequences of an upper and a lower block, 0.2 degrees each; only `laser` of the first measures.
ByteVector packet(int azimuth, std::size_t laser, int range, bool dual = false, int second = 0) {
  ByteVector out;
  for (int block = 0; block < 12; ++block) {
    const int sequence = dual ? block / 4 : block / 2;
    const auto bank = static_cast<std::size_t>(block % 2);
    append(out, {0xFF, static_cast<std::uint8_t>(bank == 0 ? 0xEE : 0xDD)});
    put_le(out, static_cast<std::uint16_t>(azimuth + 20 * sequence));
    for (std::size_t k = 0; k < 32; ++k) {
      const bool here = sequence == 0 && laser == bank * 32 + k;
      put_le(out, static_cast<std::uint16_t>(!here ? 0 : dual && block >= 2 ? second : range));
      out.push_back(9);
    }
  }
  put_le(out, std::uint32_t{0});
  append(out, {'V', 0x11});  // of the status that it tells byte by byte
  return out;
}

std::vector<Return> returns_of(const ByteVector& packet, const std::string& calibration) {
  TemporaryFolder folder;
  const std::string file = write_text(folder.path() + "/db.yaml", calibration);
  PcapWriter pcap(folder.path() + "/a.pcap");
  pcap.add(frame(packet));
  auto source = open("velodyne:" + pcap.write() + "?model=HDL-64E&calibration=" + file, {0.0, 1000});
  const auto sweeps = all_sweeps(*source);
  CHECK(source->counters().invalid_columns == 0);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].times_ns.size() == (sweeps[0].returns.size() == 2 ? 3 : 6));
  return sweeps[0].returns;
}

void check_point(const Return& r, double x, double y, double z) {
  CHECK(r.x_m == Approx(x).margin(1e-6));
  CHECK(r.y_m == Approx(y).margin(1e-6));
  CHECK(r.z_m == Approx(z).margin(1e-6));
}

}  // namespace

TEST_CASE("HDL-64E: the upper block has lasers 0 to 31, the lower one 32 to 63, of one azimuth") {
  const auto upper = returns_of(packet(9000, 4, 10000), calibration()).at(0);  // level: 2 - 4 / 2 degrees
  const double turned = (90 + 0.2 * 7.2 / 57.6) * kRadians;
  check_point(upper, 20 * std::cos(turned), -20 * std::sin(turned), 0);
  const auto lower = returns_of(packet(0, 32, 10000), calibration()).at(0);
  check_point(lower, 20 * std::cos(14 * kRadians), 0, -20 * std::sin(14 * kRadians));
}

TEST_CASE("HDL-64E: the corrections of a laser, far and near, as the manual's formula has them") {
  const double vertical = -18 * kRadians, turned = 0.2 * 14.4 / 57.6 * kRadians;  // laser 40, the third four
  const double c = std::cos(vertical), s = std::sin(vertical);
  const auto far =
      returns_of(packet(0, 40, 15000),
                 calibration("rot_correction: 0.0, dist_correction: 1.5, vert_offset_correction: 0.2, "
                             "horiz_offset_correction: 0.026"))
          .at(0);
  check_point(far, 31.5 * c * std::cos(turned) + 0.026 * std::sin(turned),
              -31.5 * c * std::sin(turned) + 0.026 * std::cos(turned), 31.5 * s + 0.2);
  const auto near =
      returns_of(packet(0, 40, 5000),
                 calibration("rot_correction: 0.0, dist_correction: 1.5, dist_correction_x: 1.7, "
                             "dist_correction_y: 1.3"))
          .at(0);
  const double level = 11.5 * c;
  const double x = level * std::sin(turned), y = level * std::cos(turned);
  const double more_x = 1.7 + (x - 2.40) / (25.04 - 2.40) * (1.5 - 1.7);
  const double more_y = 1.3 + (y - 1.93) / (25.04 - 1.93) * (1.5 - 1.3);
  check_point(near, (10 + more_y) * c * std::cos(turned), -(10 + more_x) * c * std::sin(turned),
              (10 + (more_x + more_y) / 2) * s);
}

TEST_CASE("HDL-64E: rot_correction turns a laser back") {
  const auto r =
      returns_of(packet(9000, 40, 15000), calibration("rot_correction: 0.1, dist_correction: 0.0")).at(0);
  const double turned = (90 + 0.2 * 14.4 / 57.6) * kRadians - 0.1;
  check_point(r, 30 * std::cos(-18 * kRadians) * std::cos(turned),
              -30 * std::cos(-18 * kRadians) * std::sin(turned), 30 * std::sin(-18 * kRadians));
}

TEST_CASE("HDL-64E in dual return mode: upper, lower, upper again, lower again, which the azimuths tell") {
  const auto returns = returns_of(packet(0, 36, 10000, true, 12000), calibration());
  REQUIRE(returns.size() == 2);
  CHECK(returns[1].x_m == Approx(1.2 * returns[0].x_m));
  CHECK(returns[1].z_m == Approx(1.2 * returns[0].z_m));
}

TEST_CASE("HDL-64E: a calibration that is not whole is refused with file, line, key and reason") {
  check_error("lasers: []\n", "db.yaml:1: lasers: expected a list of 64");
  check_error("3\n", "expected keys");
  check_error("a: [\n", "db.yaml:2: not YAML");
  check_error(with(calibration(), "num_lasers: 64", "num_lasers: 32"), "db.yaml:1: num_lasers: expected 64");
  check_error(with(calibration(), "laser_id: 5,", "laser_id: 6,"), "db.yaml:9: laser_id: 6 is there twice");
  check_error(with(calibration(), "laser_id: 5,", "laser_id: 64,"), "laser_id: expected a number of 0 .. 63");
  check_error(with(calibration(), "laser_id: 5,", "laser_id: 5.5,"), "laser_id: expected a whole number");
  check_error(calibration("rot_correction: 0.0"), "db.yaml:43: dist_correction: missing");
  check_error(calibration("rot_correction: .nan, dist_correction: 0.0"), "rot_correction: expected a number");
  check_error(calibration("rot_correction: 0.0, dist_correction: 150"),
              "dist_correction: expected a number of -5 .. 5");
  check_error(calibration("rot_correction: 0.0, dist_correction: 0.0, dist_correctoin_x: 1"),
              "db.yaml:43: dist_correctoin_x: unknown");
  check_error(calibration("rot_correction: 0.0, dist_correction: 0.0, dist_correction_x: 1"),
              "dist_correction_x: needs dist_correction_y");
  std::string flat = calibration();
  for (std::size_t at = 0; (at = flat.find("vert_correction: ", at)) != std::string::npos; at += 17)
    flat.replace(at + 17, flat.find(',', at) - at - 17, "0.0");
  check_error(flat, "vert_correction: only 1 angles for 64 lasers");
  check_error("<?xml version=\"1.0\"?>\n<!DOCTYPE boost_serialization>\n<boost_serialization/>\n",
              "gen_calibration.py");
  CHECK(ingest::read_velodyne_calibration("/nowhere.yaml").error() ==
        "/nowhere.yaml: cannot read the calibration");
}

TEST_CASE("a calibration belongs to an HDL-64E, and an HDL-64E needs one") {
  CHECK(open_error("velodyne:a.pcap?model=HDL-64E").find("needs calibration=FILE.yaml") != std::string::npos);
  CHECK(open_error("velodyne:a.pcap?model=VLP-16&calibration=a").find("a VLP-16 has no calibration") !=
        std::string::npos);
  TemporaryFolder folder;
  const std::string file = write_text(folder.path() + "/db.yaml", calibration());
  CHECK(open_error("velodyne:a.pcap?model=HDL-64E&model_byte=1&calibration=" + file).find("sends none") !=
        std::string::npos);
}

TEST_CASE("packets of one bank are not those of an HDL-64E") {
  TemporaryFolder folder;
  const std::string file = write_text(folder.path() + "/db.yaml", calibration());
  PcapWriter pcap(folder.path() + "/a.pcap");
  ByteVector one = packet(0, 0, 1000);
  for (std::size_t block = 0; block < 12; ++block) one[100 * block + 1] = 0xEE;
  one[1204] = 0x37;
  one[1205] = 0x22;
  pcap.add(frame(one));
  const std::string error = open_error("velodyne:" + pcap.write() + "?model=HDL-64E&calibration=" + file);
  INFO(error);
  CHECK(error.find("of another sensor (a VLP-16, model byte 0x22)") != std::string::npos);
}

TEST_CASE("an HDL-64E of the first kind, with three upper blocks to a lower one, is refused") {
  TemporaryFolder folder;
  const std::string file = write_text(folder.path() + "/db.yaml", calibration());
  PcapWriter pcap(folder.path() + "/a.pcap");
  ByteVector first = packet(0, 0, 1000);
  for (std::size_t block = 0; block < 12; ++block) first[100 * block + 1] = block % 4 == 3 ? 0xDD : 0xEE;
  pcap.add(frame(first));
  const std::string error = open_error("velodyne:" + pcap.write() + "?model=HDL-64E&calibration=" + file);
  INFO(error);
  CHECK(error.find("an HDL-64E S1, which can't be read") != std::string::npos);
}
