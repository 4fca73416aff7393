// One file for each sweep: .bin and .pcd, with times or without.
#include <liblzf/lzf.h>

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

TEST_CASE("ascii PCD: fields by name, doubles, times in nanoseconds from the stamp on") {
  TemporaryFolder folder;
  write_text(folder.path() + "/a.pcd", header("intensity z y x t", "4 8 8 8 4", "F F F F U", 3, "ascii") +
                                           "9 3 2 1 200\n9 6 5 4 100\n9 nan 5 -4.25 200\n");
  write_text(folder.path() + "/times.txt", "2.5\n");
  const Sweep sweep = only_sweep(folder.path());
  CHECK(sweep.times_ns == std::vector<std::int64_t>{2'500'000'100, 2'500'000'200});
  CHECK(sweep.stamp_ns == 2'500'000'200);
  REQUIRE(sweep.returns.size() == 3);
  CHECK(sweep.returns[0].x_m == 1);
  CHECK(sweep.returns[0].z_m == 3);
  CHECK(sweep.returns[0].time_index == 1);
  CHECK(sweep.returns[1].time_index == 0);
  CHECK(sweep.returns[2].x_m == -4.25);
  CHECK(std::isnan(sweep.returns[2].z_m));
}

TEST_CASE("PCD fields of no values, padding, and a header without POINTS") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.pcd";
  write_text(path,
             "VERSION 0.7\nFIELDS x y _ z noise _\nSIZE 4 4 1 4 2 1\nTYPE F F U F U U\nCOUNT 1 1 3 1 0 1\n"
             "WIDTH 2\nHEIGHT 2\nDATA ascii\n1 2 0 0 0 3 0\n4 5 0 0 0 6 0\n7 8 0 0 0 9 0\n1 1 0 0 0 1 0\n");
  const Sweep sweep = only_sweep(path);
  REQUIRE(sweep.returns.size() == 4);
  CHECK(sweep.returns[1].x_m == 4);
  CHECK(sweep.returns[1].z_m == 6);
  ByteVector body;
  for (const float value : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F}) put_le(body, value);
  write(path,
        joined("FIELDS x none y z\nSIZE 4 8 4 4\nTYPE F F F F\nCOUNT 1 0 1 1\nWIDTH 2\nDATA binary\n", body));
  CHECK(only_sweep(path).returns.at(1).y_m == 5);
}

TEST_CASE("a PCD's points are as many as its header says, or it is told") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.pcd";
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  write_text(path, fields + "WIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n");
  CHECK(read_error(path) == path + ": POINTS is 5, WIDTH * HEIGHT 6");
  write_text(path, fields + "DATA ascii\n1 2 3\n");
  CHECK(read_error(path) == path + ": neither POINTS nor WIDTH");
  write_text(path, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 0 0\nWIDTH 3\nDATA binary\n");
  CHECK(read_error(path) == path + ": points of no bytes");
  write_text(path, "FIELDS x y z w\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 0 1\nWIDTH 1\nDATA ascii\n1 2 3\n");
  CHECK(read_error(path) == path + ": no floating-point fields x, y, z");
  write(path, joined(fields + "POINTS 1\nDATA binary\n", ByteVector(36, 0x40)));
  for (int kind = 0; kind < 2; ++kind) {
    const auto source = open("scans:" + path);
    CHECK(all_sweeps(*source).at(0).returns.size() == 1);
    REQUIRE_FALSE(source->warnings().empty());
    CHECK(source->warnings().back() ==
          path + ": holds 2 points more than its header says, which are left out");
    write_text(path, fields + "POINTS 1\nDATA ascii\n1 2 3\n\n4 5 6\n7 8 9\n");
  }
}

TEST_CASE("ascii PCD: a point is a line, so that one that lacks a number moves no other") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.pcd";
  const auto error_of = [&](const std::string& rows) {
    return read_error(write_text(path, header("x y z", "4 4 4", "F F F", 2, "ascii") + rows));
  };
  CHECK_THAT(error_of("1 2 3 0.5\n4 5 6 0.5\n"),
             Catch::Contains("more than 3 numbers") && Catch::Contains("'0.5'"));
  CHECK_THAT(error_of("1 2 3\n\n4 5\n6 7 8\n"), Catch::Contains(": line 13: z is ''"));
  CHECK_THAT(error_of("1 2 3\n"),
             Catch::Contains("holds 1 of its 2 points") || Catch::Contains("fewer points"));
}

TEST_CASE("a scan that is not in metres, or no sweep at all, is refused by name") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.pcd";
  write_text(path, header("x y z", "4 4 4", "F F F", 2, "ascii") + "1200 900 -30\n-4000 70 2\n");
  CHECK(read_error(path) == path + ": 2 of its 2 hits are beyond 500 m: not metres?");
  write_text(path, header("x y z", "4 4 4", "F F F", 2, "ascii") + "nan nan nan\n0 0 0\n");
  const auto empty = open("scans:" + path);
  all_sweeps(*empty);
  REQUIRE_FALSE(empty->warnings().empty());
  CHECK_THAT(empty->warnings().back(), Catch::Contains("no hit in the whole scan"));
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
  CHECK_THAT(read_error(path), Catch::StartsWith(path + ": its 1099511627776 bytes are no sweep's"));
}

TEST_CASE("compressed PCD: one array a field") {
  TemporaryFolder folder;
  constexpr int kPoints = 100;
  ByteVector arrays;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kPoints; ++i) put_le(arrays, static_cast<float>(axis * 100 + i / 10));
  }
  ByteVector packed(arrays.size() + 100);
  packed.resize(lzf_compress(arrays.data(), static_cast<unsigned>(arrays.size()), packed.data(),
                             static_cast<unsigned>(packed.size())));
  REQUIRE_FALSE(packed.empty());
  ByteVector body;
  put_le(body, static_cast<std::uint32_t>(packed.size()));
  put_le(body, static_cast<std::uint32_t>(arrays.size()));
  append(body, packed);
  const std::string head = header("x y z", "4 4 4", "F F F", kPoints, "binary_compressed");
  const std::string path = write(folder.path() + "/a.pcd", joined(head, body));
  const Sweep sweep = only_sweep(path);
  REQUIRE(sweep.returns.size() == kPoints);
  CHECK(sweep.returns[57].x_m == 5);
  CHECK(sweep.returns[57].y_m == 105);
  CHECK(sweep.returns[57].z_m == 205);

  body.resize(body.size() - 4);
  write(path, joined(head, body));
  CHECK(read_error(path).find("cut off") != std::string::npos);
  body[0] = static_cast<std::uint8_t>(body[0] - 4);
  write(path, joined(head, body));
  CHECK(read_error(path).find("corrupt") != std::string::npos);
  body[4] = 0;
  write(path, joined(head, body));
  CHECK(read_error(path).find("unpacks to") != std::string::npos);
}

TEST_CASE("broken PCD files are refused, naming what is wrong") {
  TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    return read_error(write_text(folder.path() + "/a.pcd", text));
  };
  CHECK(error_of("").find("no DATA line") != std::string::npos);
  CHECK(error_of("DATA ascii\n").find("no FIELDS") != std::string::npos);
  CHECK(error_of(header("x y", "4 4", "F F", 0, "ascii")).find("no floating-point fields x, y, z") !=
        std::string::npos);
  CHECK(error_of(header("x y z", "4 4", "F F F", 0, "ascii")).find("line 4: SIZE: not as many as FIELDS") !=
        std::string::npos);
  CHECK(error_of(header("x y z", "4 4 3", "F F F", 0, "ascii")).find("field 'z'") != std::string::npos);
  CHECK(error_of(header("x y z", "4 4 4", "F F F", 2, "binary") + "0123").find("holds 0 of its 2 points") !=
        std::string::npos);
  CHECK(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 three\n").find(": z is 'three'") !=
        std::string::npos);
  CHECK(error_of(header("x y z", "4 4 4", "F F F", 1, "base64")).find("DATA base64 is not known") !=
        std::string::npos);
  CHECK(error_of(header("x y z t", "4 4 4 4", "F F F F", 1, "ascii") + "1 2 3 nan\n")
            .find("point 0: 't' is not a time") != std::string::npos);
}
