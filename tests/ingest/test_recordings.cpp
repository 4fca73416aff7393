// Real recordings: the counts that are known of them, and geometry that makes sense.
#include <algorithm>
#include <cmath>

#include "tests/ingest/recordings.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

double range_m(const Return& r) {
  return std::hypot(r.x_m, r.y_m, r.z_m);
}

double farthest_m(const Sweep& sweep) {
  double farthest = 0;
  for (const Return& r : sweep.returns) farthest = std::max(farthest, range_m(r));
  return farthest;
}

/// The height that most returns 4 .. 15 m away share (the fullest of bins of 5 cm), below the sensor: the
/// ground.
double ground_z_m(const Sweep& sweep) {
  std::vector<int> bins(100);
  for (const Return& r : sweep.returns) {
    const double level = std::hypot(r.x_m, r.y_m);
    if (level > 4 && level < 15 && r.z_m < 0 && r.z_m > -5) ++bins[static_cast<std::size_t>(-r.z_m / 0.05)];
  }
  return -0.05 * (0.5 + static_cast<double>(std::max_element(bins.begin(), bins.end()) - bins.begin()));
}

std::string ouster(const std::string& data, const std::string& name) {
  return "ouster:" + data + "/" + name + ".pcap?meta=" + data + "/" + name + ".json";
}

}  // namespace

TEST_CASE("OS1-128, low bandwidth profile: three whole sweeps 0.1 s apart, IMU packets are foreign") {
  const auto data = recordings();
  if (!data) return;
  auto source = open(ouster(*data, "ouster_os1_128_moving/os1_128"));
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 3);
  CHECK(source->warnings().empty());
  CHECK(source->counters().packets == 192 + 30);
  CHECK(source->counters().foreign_packets == 30);
  CHECK(source->counters().incomplete_sweeps == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(sweeps[i].complete);
    CHECK(sweeps[i].times_ns.size() == 1024);
    CHECK(sweeps[i].received_ns == 0);
    CHECK(ground_z_m(sweeps[i]) == Approx(-1.95).margin(0.15));
    if (i > 0)
      CHECK(static_cast<double>(sweeps[i].stamp_ns - sweeps[i - 1].stamp_ns) == Approx(1e8).epsilon(0.01));
  }
  CHECK(farthest_m(sweeps[1]) == Approx(246.9).margin(0.1));
}

TEST_CASE("OS1-64, legacy profile: one whole sweep, the halves around it are dropped and counted") {
  const auto data = recordings();
  if (!data) return;
  auto source = open(ouster(*data, "ouster_os1_64_legacy/os1_64"));
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 58797);
  CHECK(sweeps[0].times_ns.size() == 1024);
  CHECK(farthest_m(sweeps[0]) == Approx(134.9).margin(0.1));
  CHECK(source->counters().packets == 100);
  CHECK(source->counters().dropped_sweeps == 2);
  CHECK(source->warnings().size() == 3);  // no data_format, no beam offset, no transform
}

TEST_CASE("OS1-64, legacy profile: with min_sweep_fraction 0 the halves are handed out as incomplete") {
  const auto data = recordings();
  if (!data) return;
  auto source = open(ouster(*data, "ouster_os1_64_legacy/os1_64"), {0.0, 262144});
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 3);
  CHECK_FALSE(sweeps[0].complete);
  CHECK(sweeps[1].complete);
  CHECK_FALSE(sweeps[2].complete);
  CHECK(source->counters().incomplete_sweeps == 2);
  CHECK(source->counters().dropped_sweeps == 0);
  CHECK(sweeps[0].times_ns.size() + sweeps[2].times_ns.size() == 36 * 16);
}

TEST_CASE("OS2-128 and OS1-32: the known counts") {
  const auto data = recordings();
  if (!data) return;
  auto os2 = open(ouster(*data, "ouster_variants/os2_128_rng19"));
  const auto os2_sweeps = all_sweeps(*os2);
  REQUIRE(os2_sweeps.size() == 1);
  CHECK(os2_sweeps[0].returns.size() == 119682);
  CHECK(farthest_m(os2_sweeps[0]) == Approx(331.6).margin(0.1));
  auto os1 = open(ouster(*data, "ouster_variants/os1_32_legacy"));
  const auto os1_sweeps = all_sweeps(*os1);
  REQUIRE(os1_sweeps.size() == 1);
  CHECK(os1_sweeps[0].returns.size() == 27310);
}

TEST_CASE("a recording starts again with the same bytes") {
  const auto data = recordings();
  if (!data) return;
  for (const std::string& uri :
       {ouster(*data, "ouster_os1_128_moving/os1_128"),
        "velodyne:" + *data + "/velodyne/hdl32.pcap?model=HDL-32", "scans:" + *data + "/kitti_drive0005"}) {
    auto source = open(uri);
    const auto first = all_sweeps(*source);
    REQUIRE(source->rewind().has_value());
    const auto second = all_sweeps(*source);
    REQUIRE(first.size() == second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      CHECK(first[i].stamp_ns == second[i].stamp_ns);
      CHECK(first[i].times_ns == second[i].times_ns);
      REQUIRE(first[i].returns.size() == second[i].returns.size());
      const bool same = std::equal(first[i].returns.begin(), first[i].returns.end(),
                                   second[i].returns.begin(), [](const Return& a, const Return& b) {
                                     return a.x_m == b.x_m && a.y_m == b.y_m && a.z_m == b.z_m &&
                                            a.time_index == b.time_index;
                                   });
      CHECK(same);
    }
  }
}

TEST_CASE("HDL-32: whole turns of 0.11 s over flat ground") {
  const auto data = recordings();
  if (!data) return;
  auto source = open("velodyne:" + *data + "/velodyne/hdl32.pcap?model=HDL-32");
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 2);  // and two pieces under half a turn
  CHECK(source->counters().dropped_sweeps == 2);
  CHECK(source->warnings().empty());
  for (const Sweep& sweep : sweeps) {
    CHECK(sweep.complete);
    CHECK(sweep.returns.size() == Approx(57800).margin(200));
    CHECK(ground_z_m(sweep) == Approx(-2.15).margin(0.15));
  }
  CHECK(farthest_m(sweeps[0]) == Approx(81.3).margin(0.1));
  CHECK(static_cast<double>(sweeps[1].stamp_ns - sweeps[0].stamp_ns) == Approx(1.106e8).epsilon(0.01));
  CHECK(sweeps[0].stamp_ns / 1'000'000'000 == 1319768035);  // the hour of the capture, the sensor's minutes
}

TEST_CASE("VLP-16: position packets do no harm; a wrong model byte is taken where the source names it") {
  const auto data = recordings();
  if (!data) return;
  auto indoors = open("velodyne:" + *data + "/velodyne/vlp16_gps.pcap?model=VLP-16");
  const auto turns = all_sweeps(*indoors);
  CHECK(turns.size() == 4);
  CHECK(indoors->counters().packets == 350);
  CHECK(indoors->counters().foreign_packets == 57);
  CHECK(std::count_if(turns.begin(), turns.end(), [](const Sweep& s) { return s.complete; }) == 3);

  const std::string wrong_byte = "velodyne:" + *data + "/velodyne/vlp16_outdoor.pcap?model=VLP-16";
  CHECK(open_error(wrong_byte).find("an HDL-32, model byte 0x21") != std::string::npos);
  auto outdoors = open(wrong_byte + "&model_byte=0x21");
  const auto sweeps = all_sweeps(*outdoors);
  REQUIRE(sweeps.size() == 1);
  CHECK_FALSE(sweeps[0].complete);  // the recording ends at 290 degrees
  CHECK(farthest_m(sweeps[0]) == Approx(109.8).margin(0.1));
  CHECK(outdoors->warnings().empty());
}

TEST_CASE("VLS-128: both halves of a turn and more; every other model refuses it by name") {
  const auto data = recordings();
  if (!data) return;
  const std::string uri = "velodyne:" + *data + "/field/velodyne_vls128/vls128.pcap?model=";
  for (const char* model : {"VLP-16", "Puck-Hi-Res", "VLP-32C", "HDL-32"}) {
    CHECK(open_error(uri + model).find("of another sensor (a VLS-128, model byte 0xA1)") !=
          std::string::npos);
  }
  auto source = open(uri + "VLS-128");
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 2);
  CHECK(source->counters().packets == 700);
  CHECK(source->counters().invalid_columns == 0);
  CHECK(sweeps[0].times_ns.size() + sweeps[1].times_ns.size() == 2100);
  CHECK(sweeps[0].returns.size() == 135541);
  CHECK(sweeps[1].returns.size() == 105203);
  CHECK_FALSE(sweeps[0].complete);
  CHECK_FALSE(sweeps[1].complete);
  CHECK(ground_z_m(sweeps[1]) == Approx(-1.85).margin(0.1));
}

TEST_CASE("KITTI: ten sweeps with the stamps of times.txt, the sensor 1.73 m above the street") {
  const auto data = recordings();
  if (!data) return;
  auto source = open("scans:" + *data + "/kitti_drive0005");
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 10);
  CHECK(source->warnings().empty());
  CHECK(sweeps[0].returns.size() == 123527);
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(sweeps[i].stamp_ns == 9'000'000'000 + static_cast<std::int64_t>(i) * 100'000'000);
    CHECK(ground_z_m(sweeps[i]) == Approx(-1.73).margin(0.2));
  }
  auto folder = open("scans:" + *data + "/kitti_drive0005/velodyne/");
  CHECK(all_sweeps(*folder).front().stamp_ns == 9'000'000'000);  // times.txt of the folder above
}

TEST_CASE("a forest in one PCD: a time for each of its 1024 columns") {
  const auto data = recordings();
  if (!data) return;
  auto source = open("scans:" + *data + "/forest/marv_ouster.pcd");
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].returns.size() == 91900);
  CHECK(sweeps[0].times_ns.size() == 1024);
  CHECK(sweeps[0].stamp_ns == sweeps[0].times_ns.back());
  CHECK(sweeps[0].stamp_ns == Approx(1e8).epsilon(0.01));
  CHECK(farthest_m(sweeps[0]) == Approx(37.3).margin(0.1));
}

TEST_CASE("FUSA, dual returns: an eighth of a frame, with the counts that are known of it") {
  const auto data = recordings();
  if (!data) return;
  const std::string folder = "field/ouster_fusa_rng15_dual/";
  auto source = open(ouster(*data, folder + "OS-1-128_767798045_1024x10_20230712_120049"), {0.0, 262144});
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].times_ns.size() == 128);
  CHECK(sweeps[0].returns.size() == 16373 + 1089);  // first returns, second ones that are others
  CHECK(source->counters().foreign_packets == 2);   // IMU
}

TEST_CASE("two Ousters on one port: each metadata takes its own sensor's packets") {
  const auto data = recordings();
  if (!data) return;
  const std::string folder = *data + "/field/ouster_fusa_rng15_dual/";
  const std::string fusa = "ouster:" + folder + "same_ports.pcap?meta=" + folder + "same_ports.1.json";
  auto source = open(fusa, {0.0, 262144});
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  CHECK(sweeps[0].times_ns.size() == 16);
  CHECK(sweeps[0].returns.size() == 1964);
  CHECK(source->counters().foreign_packets == 3);  // the other sensor's, and two of IMUs
}

TEST_CASE("metadata of another sensor is refused, naming both sizes") {
  const auto data = recordings();
  if (!data) return;
  const std::string error = open_error("ouster:" + *data + "/ouster_os1_64_legacy/os1_64.pcap?meta=" + *data +
                                       "/ouster_os1_128_moving/os1_128.json");
  CHECK(error.find("128 beams, RNG15_RFL8_NIR8: packets of 8448 bytes") != std::string::npos);
  CHECK(error.find("100 of 12608 bytes") != std::string::npos);
}
