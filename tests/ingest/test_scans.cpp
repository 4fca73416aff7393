// One file for each sweep, with times or without; what a .bin holds.
#include <cmath>
#include <filesystem>
#include <limits>

#include "services/ingest/scan_files.hpp"
#include "tests/ingest/scan_builder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

TEST_CASE("a .bin holds float32 x y z intensity; zeros and NaN stay returns") {
  TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write(folder.path() + "/b.bin", bin({0, 0, 0, 0, nan, 1, 2, 0}));
  write(folder.path() + "/a.bin", bin({1.5F, -2, 3, 0.5F}));
  write_text(folder.path() + "/times.txt", "1000000000.000000001\n1000000000.1\n\n");
  auto source = open("scans:" + folder.path());
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 2);
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("b.bin: no hit in the whole scan") != std::string::npos);
  CHECK(sweeps[0].stamp_ns == 1'000'000'000'000'000'001);
  CHECK(sweeps[0].times_ns == std::vector<std::int64_t>{1'000'000'000'000'000'001});
  REQUIRE(sweeps[0].returns.size() == 1);
  CHECK(sweeps[0].returns[0].x_m == 1.5);
  CHECK(sweeps[0].returns[0].y_m == -2);
  CHECK(sweeps[0].returns[0].z_m == 3);
  REQUIRE(sweeps[1].returns.size() == 2);
  CHECK(std::isnan(sweeps[1].returns[1].x_m));
}

TEST_CASE("without times.txt scans are 0.1 s apart, and a warning says so") {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() + "/velodyne");
  for (const char* name : {"/velodyne/0.bin", "/velodyne/1.bin"})
    write(folder.path() + name, bin({1, 2, 3, 4}));
  auto source = open("scans:" + folder.path());
  CHECK(source->warnings().size() == 1);
  CHECK(all_sweeps(*source).at(1).stamp_ns == 100'000'000);
}

TEST_CASE("times.txt is refused with file and line") {
  TemporaryFolder folder;
  for (const char* name : {"/0.bin", "/1.bin"}) write(folder.path() + name, bin({1, 2, 3, 4}));
  const auto error_of = [&](const std::string& times) {
    write_text(folder.path() + "/times.txt", times);
    return open_error("scans:" + folder.path());
  };
  const std::string times = folder.path() + "/times.txt";
  const std::string names = folder.path() + "/0.bin .. 1.bin";
  CHECK(error_of("1\n1\n") == times + ":2: time does not go forward");
  CHECK(error_of("1\nnan\n").find(times + ":2: 'nan' is not a time") == 0);
  CHECK(error_of("1\n2\n\n3\n") == times + ": 3 times for 2 scans, " + names + ": line 4 is one too many");
  CHECK(error_of("1\n") ==
        times + ": 1 times for 2 scans, " + names + ": none for " + folder.path() + "/1.bin");
}

TEST_CASE("scans come in the order in which a person counts") {
  using ingest::in_natural_order;
  CHECK(in_natural_order("8.bin", "10.bin"));
  CHECK_FALSE(in_natural_order("10.bin", "8.bin"));
  CHECK(in_natural_order("a9_2.bin", "a10_1.bin"));
  CHECK(in_natural_order("000009.bin", "10.bin"));
  CHECK(in_natural_order("01.bin", "1.bin"));
  CHECK_FALSE(in_natural_order("1.bin", "01.bin"));
  CHECK(in_natural_order("99999999999999999999999999998.bin", "99999999999999999999999999999.bin"));
  CHECK_FALSE(in_natural_order("a.bin", "a.bin"));
  CHECK(in_natural_order("scan.bin", "scan1.bin") == ('.' < '1'));

  TemporaryFolder folder;
  for (const int i : {8, 9, 10, 100})
    write(folder.path() + "/" + std::to_string(i) + ".bin", bin({static_cast<float>(i), 2, 3, 4}));
  write(folder.path() + "/._9.bin", ByteVector(3));  // of another system, beside each file
  write_text(folder.path() + "/times.txt", "0.8\n0.9\n1.0\n10\n");
  const auto sweeps = all_sweeps(*open("scans:" + folder.path()));
  REQUIRE(sweeps.size() == 4);
  CHECK(sweeps[2].returns[0].x_m == 10);
  CHECK(sweeps[2].stamp_ns == 1'000'000'000);
}

TEST_CASE("KITTI raw: from the drive's folder, with the dates beside") {
  TemporaryFolder folder;
  const std::string scans = folder.path() + "/velodyne_points/data";
  std::filesystem::create_directories(scans);
  write(scans + "/0000000090.bin", bin({1, 2, 3, 4}));
  write(scans + "/0000000091.bin", bin({1, 2, 3, 4}));
  write_text(folder.path() + "/velodyne_points/timestamps.txt",
             "2011-09-26 13:02:25.951199337\n2011-09-26 13:02:26.054599337\n");
  for (const char* path : {"", "/", "/velodyne_points", "/velodyne_points/data", "/velodyne_points/data/"}) {
    const auto source = open("scans:" + folder.path() + path);
    CHECK(source->warnings().empty());
    CHECK(all_sweeps(*source).at(1).stamp_ns == 1317042146054599337);
  }
  CHECK(all_sweeps(*open("scans:" + scans + "/0000000091.bin")).at(0).stamp_ns == 1317042146054599337);
}

TEST_CASE(
    "times that are not used, or may not be in seconds, are told of; of two files of times none is taken") {
  TemporaryFolder folder;
  const std::string scans = folder.path() + "/lidar";
  std::filesystem::create_directories(scans);
  for (const char* name : {"/0.bin", "/1.bin"}) write(scans + name, bin({1, 2, 3, 4}));
  write_text(folder.path() + "/times.txt", "1\n2\n");
  const auto unused = open("scans:" + scans);
  REQUIRE(unused->warnings().size() == 2);
  CHECK(unused->warnings()[0].find(folder.path() + "/times.txt: not used") == 0);
  write_text(scans + "/times.txt", "100000\n200000\n");
  const auto odd = open("scans:" + scans);
  REQUIRE(odd->warnings().size() == 1);
  CHECK(odd->warnings()[0].find("scans are 100000 s apart") != std::string::npos);
  write_text(scans + "/timestamps.txt", "1\n2\n");
  CHECK(open_error("scans:" + scans).find("which has the times of the scans?") != std::string::npos);
}

TEST_CASE("scans from the field come with their stamps") {
  const auto data = recordings();
  if (!data) return;
  const std::string field = *data + "/field/";
  const auto counted = open("scans:" + field + "scan_order_1_10_2");
  CHECK(counted->warnings().empty());
  const auto sweeps = all_sweeps(*counted);
  REQUIRE(sweeps.size() == 10);
  CHECK(sweeps[0].returns.size() == 32944 / 16);  // 8.bin
  CHECK(sweeps[9].returns.size() == 32752 / 16);  // 17.bin
  const auto raw = open("scans:" + field + "kitti_raw_layout");
  CHECK(raw->warnings().empty());
  CHECK(all_sweeps(*raw).at(0).stamp_ns == 1317042145951199337);
  const auto points_of = [&](const std::string& name) { return only_sweep(field + name).returns.size(); };
  CHECK(points_of("pcd_count0_padding/0.pcd") == 11488);
  CHECK(points_of("pcd_without_points/0.pcd") == 11488);
}

TEST_CASE("paths that hold no scans are refused") {
  TemporaryFolder folder;
  CHECK(open_error("scans:" + folder.path() + "/none").find("no such file or folder") != std::string::npos);
  CHECK(open_error("scans:" + folder.path()).find("no .bin or .pcd files") != std::string::npos);
  CHECK(open_error("scans:" + write_text(folder.path() + "/a.txt", "")).find("neither") != std::string::npos);
  write(folder.path() + "/a.bin", {});
  write(folder.path() + "/a.pcd", {});
  CHECK(open_error("scans:" + folder.path()).find("holds .bin and .pcd") != std::string::npos);
  TemporaryFolder two;
  for (const char* below : {"/velodyne", "/data"}) {
    std::filesystem::create_directory(two.path() + below);
    write(two.path() + below + "/a.bin", {});
  }
  CHECK(open_error("scans:" + two.path()).find("hold scans: name one of them") != std::string::npos);
}

TEST_CASE("a .bin of an odd size ends the source, naming file and size") {
  TemporaryFolder folder;
  write(folder.path() + "/0.bin", bin({1, 2, 3, 4}));
  write(folder.path() + "/1.bin", ByteVector(17));
  auto source = open("scans:" + folder.path());
  Sweep sweep;
  CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kSweep);
  const auto bad = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(bad.has_value());
  CHECK(bad.error() == folder.path() + "/1.bin: its size of 17 bytes is not a multiple of 16");
}

TEST_CASE("returns beyond max_returns are counted") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.bin";
  write(path, ByteVector(16 * 10));
  auto source = open("scans:" + path, {0.5, 7});
  CHECK(all_sweeps(*source).at(0).returns.size() == 7);
  CHECK(source->counters().overflow_returns == 3);
  REQUIRE_FALSE(source->warnings().empty());
  CHECK(source->warnings().back() == path + ": 10 points, of which max_returns takes 7");
}
