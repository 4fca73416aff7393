// No map without a reason: what is said of a recording whose sweeps were dropped.
#include "services/ingest/loss_words.hpp"
#include "services/ingest/source_check.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using ingest::explain;

namespace {

services::LidarConfig lidar_v() {
  services::LidarConfig lidar;
  lidar.name = "v";
  return lidar;
}

}  // namespace

TEST_CASE("dropped sweeps, returns left out and a recording without sweeps are explained by their keys") {
  ingest::SourceCounters counters;
  counters.sweeps = 3;
  CHECK(explain(counters, lidar_v()).empty());
  counters.dropped_sweeps = 9;
  counters.best_dropped_fraction = 0.331;
  counters.overflow_returns = 7;
  const auto lines = explain(counters, lidar_v());
  REQUIRE(lines.size() == 2);
  CHECK(
      lines[0] ==
      "9 of 12 sweeps dropped: they have 33 % of their columns at most, lidars.v.min_sweep_fraction is 0.5");
  CHECK(lines[1] == "7 returns left out: lidars.v.max_returns is 262144");

  ingest::SourceCounters none;
  none.packets = 5;
  none.foreign_packets = 5;
  const auto why = explain(none, lidar_v());
  REQUIRE(why.size() == 1);
  CHECK(why[0].find("no sweep came: 5 packets, of which 5 are not of such a sensor") == 0);
}

TEST_CASE("sweeps of another mode or pace are not said to lack columns") {
  ingest::SourceCounters counters;
  counters.packets = 12;
  counters.misfit_sweeps = 6;
  const auto lines = explain(counters, lidar_v());
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "6 of 6 sweeps dropped: they are of another mode or pace than lidars.v.source says");
}

TEST_CASE("a recording of another mode: the check of its source says so, with what the source noticed") {
  TemporaryFolder folder;
  OusterSensor sensor;
  sensor.mode = "16x10";
  sensor.column_ns = 100'000'000 / 16;
  sensor.frame_ns = 50'000'000;  // of 8 columns
  PcapWriter pcap(folder.path() + "/half.pcap");
  for (int id = 1; id <= 6; ++id)
    for (const int column : {0, 4}) pcap.add(frame(plain_packet(sensor, id, column)), {});
  services::LidarConfig lidar = lidar_v();
  lidar.source = "ouster:" + pcap.write() + "?meta=" + write_text(folder.path() + "/m.json", sensor.json());
  const auto checked = ingest::check_source(lidar);
  REQUIRE_FALSE(checked.has_value());
  INFO(checked.error().what);
  CHECK(checked.error().what.find("turns end with column 7, the metadata has 16") == 0);
  CHECK(checked.error().what.find("6 of 6 sweeps dropped: they are of another mode") != std::string::npos);
  CHECK(checked.error().what.find("min_sweep_fraction") == std::string::npos);
}

TEST_CASE("a Velodyne restricted to 120 degrees, once past them and past 0 in their middle") {
  const auto data = recordings();
  if (!data) return;
  const std::string uri =
      "velodyne:" + *data + "/field/no_map_no_reason/v_fov120.pcap?model=VLP-16&model_byte=0x21";
  const auto source = open(uri);
  CHECK(all_sweeps(*source).empty());
  const auto lines = explain(source->counters(), lidar_v());
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] ==
        "2 of 2 sweeps dropped: they have 17 % of their columns at most, lidars.v.min_sweep_fraction is 0.5");
  CHECK(all_sweeps(*open(uri, {0.1})).size() == 2);
}
