// One pixel at a known place: the answer follows from the manufacturer's formula on paper.
#include <cmath>

#include "services/ingest/ouster_geometry.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

/// The returns of a frame of one packet with this column among its four.
std::vector<Return> returns_of(const OusterSensor& sensor, const Column& column) {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
  std::vector<Column> columns(4, {0, {0, 0}, {}, false});
  columns[1] = column;
  PcapWriter pcap(folder.path() + "/one.pcap");
  pcap.add(frame(ouster_packet(sensor, 7, columns)));
  auto source = open("ouster:" + pcap.write() + "?meta=" + meta, {0.0, 1000});
  const auto sweeps = all_sweeps(*source);
  CHECK(source->counters().invalid_columns == 3);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].times_ns == std::vector<std::int64_t>{column_time_ns(7, column.id)});
  return sweeps[0].returns;
}

void check_point(const Return& r, double x, double y, double z) {
  CHECK(r.x_m == Approx(x).margin(1e-9));
  CHECK(r.y_m == Approx(y).margin(1e-9));
  CHECK(r.z_m == Approx(z).margin(1e-9));
}

}  // namespace

TEST_CASE("column 0 looks along x; a quarter of a turn later the lidar looks along -y") {
  const auto first = returns_of({}, {0, {10000, 0}});
  REQUIRE(first.size() == 1);
  check_point(first[0], 10, 0, 0);
  const auto quarter = returns_of({}, {4, {10000, 4000}});
  REQUIRE(quarter.size() == 2);
  check_point(quarter[0], 0, -10, 0);
  check_point(quarter[1], 0, -4 * std::sqrt(0.75), 2);  // 30 degrees up
}

TEST_CASE("the beam's origin lies off the axis, towards the column") {
  OusterSensor sensor;
  sensor.beam_offset_mm = "20";
  const auto up = returns_of(sensor, {0, {10000, 10000}});
  REQUIRE(up.size() == 2);
  check_point(up[0], 10, 0, 0);
  check_point(up[1], 9.98 * std::sqrt(0.75) + 0.02, 0, 4.99);
}

TEST_CASE("a positive beam azimuth turns the beam clockwise, about the axis and not about its origin") {
  OusterSensor sensor;
  sensor.azimuths = "[90, 0]";
  sensor.beam_offset_mm = "20";
  const auto aside = returns_of(sensor, {0, {10000, 0}});
  REQUIRE(aside.size() == 1);
  check_point(aside[0], 0.02, -9.98, 0);
}

TEST_CASE("returns are in the sensor's frame, not the lidar's") {
  OusterSensor sensor;
  sensor.transform = "[-1,0,0,0, 0,-1,0,0, 0,0,1,36.18, 0,0,0,1]";
  const auto moved = returns_of(sensor, {4, {10000, 0}});
  REQUIRE(moved.size() == 1);
  check_point(moved[0], 0, 10, 0.03618);
}

TEST_CASE("each profile's range unit and width") {
  OusterSensor sensor;
  sensor.profile = "RNG15_RFL8_NIR8";
  check_point(returns_of(sensor, {0, {0x7FFF, 0}}).at(0), 0x7FFF * 0.008, 0, 0);
  sensor.profile = "RNG19_RFL8_SIG16_NIR16";
  check_point(returns_of(sensor, {0, {0x7FFFF, 0}}).at(0), 0x7FFFF * 0.001, 0, 0);
  sensor.profile = "LEGACY";
  check_point(returns_of(sensor, {0, {0xFFFFF, 0}}).at(0), 0xFFFFF * 0.001, 0, 0);
}

TEST_CASE("dual returns: both count, the second only if it is there and another one") {
  OusterSensor sensor;
  sensor.profile = "RNG19_RFL8_SIG16_NIR16_DUAL";
  const auto both = returns_of(sensor, {0, {5000, 0}, {8000, 0}});
  REQUIRE(both.size() == 2);
  check_point(both[0], 5, 0, 0);
  check_point(both[1], 8, 0, 0);
  CHECK(both[0].time_index == both[1].time_index);
  CHECK(returns_of(sensor, {0, {5000, 4000}, {5000, 0}}).size() == 2);
}

TEST_CASE("every profile: ranges in its own unit, the second return where it has one, nothing of the rest") {
  struct Known {
    const char* profile;
    std::uint32_t range;
    double metres;
    bool dual;
  };
  const Known all[] = {{"LEGACY", 0xFFFFF, 0xFFFFF * 0.001, false},
                       {"RNG15_RFL8_NIR8", 0x7FFF, 0x7FFF * 0.008, false},
                       {"RNG15_RFL8_WIN8", 0x7FFF, 0x7FFF * 0.008, false},
                       {"RNG15_RFL8_NIR8_DUAL", 0x7FFF, 0x7FFF * 0.008, true},
                       {"FUSA_RNG15_RFL8_NIR8_DUAL", 0x7FFF, 0x7FFF * 0.008, true},
                       {"RNG15_RFL8_NIR8_ZONE16", 0x7FFF, 0x7FFF * 0.008, false},
                       {"RNG19_RFL8_SIG16_NIR16", 0x7FFFF, 0x7FFFF * 0.001, false},
                       {"RNG19_RFL8_SIG16_NIR16_ZONE16", 0x7FFFF, 0x7FFFF * 0.001, false},
                       {"RNG19_RFL8_SIG16_NIR16_DUAL", 0x7FFFF, 0x7FFFF * 0.001, true},
                       {"RNG19_RFL8_SIG16_ZONE16_DUAL", 0x7FFFF, 0x7FFFF * 0.001, true},
                       {"RNG19_RFL8_SIG16_NIR16_RGB16", 0x7FFFF, 0x7FFFF * 0.001, false},
                       {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", 0x7FFFF, 0x7FFFF * 0.001, true}};
  for (const Known& known : all) {
    INFO(known.profile);
    OusterSensor sensor;
    sensor.profile = known.profile;
    sensor.serial = 122246000293;
    const auto level = returns_of(sensor, {0, {known.range, 0}, {1000, 0}});
    REQUIRE(level.size() == (known.dual ? 2 : 1));
    check_point(level[0], known.metres, 0, 0);
    if (known.dual) check_point(level[1], 1000 * known.metres / known.range, 0, 0);
    const auto tilted = returns_of(sensor, {0, {0, 1000}, {0, 1000}});  // the beam 30 degrees up
    REQUIRE(tilted.size() == 1);
    CHECK(tilted[0].z_m == Approx(500 * known.metres / known.range));
  }
}

TEST_CASE("the tables agree with the formula for every pixel of a real sensor") {
  const auto data = recordings();
  if (!data) return;
  std::vector<std::string> warnings;
  const auto meta = ingest::read_ouster_metadata(*data + "/ouster_os1_128_moving/os1_128.json", warnings);
  REQUIRE(meta.has_value());
  const ingest::OusterGeometry geometry(*meta);
  const double pi = std::acos(-1.0), n = 15.806, r = 43210;
  double worst = 0;
  for (int column = 0; column < 1024; ++column) {
    for (std::size_t beam = 0; beam < 128; ++beam) {
      const double t = 2 * pi * (1 - column / 1024.0), a = -meta->beam_azimuth_deg[beam] * pi / 180;
      const double p = meta->beam_altitude_deg[beam] * pi / 180;
      const double x = (r - n) * std::cos(t + a) * std::cos(p) + n * std::cos(t);
      const double y = (r - n) * std::sin(t + a) * std::cos(p) + n * std::sin(t);
      const double z = (r - n) * std::sin(p);
      const auto got =
          geometry.project(geometry.columns[static_cast<std::size_t>(column)], geometry.beams[beam], r);
      worst =
          std::max(worst, std::hypot(got.x_m + x / 1000, got.y_m + y / 1000, got.z_m - (z + 36.18) / 1000));
    }
  }
  CHECK(worst < 1e-12);
}
