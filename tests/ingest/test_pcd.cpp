// Point clouds as .pcd files: ascii, binary and compressed, and what is wrong with them.
#include <liblzf/lzf.h>

#include <cmath>
#include <filesystem>

#include "tests/ingest/scan_builder.hpp"

using namespace gvom;
using namespace gvom::test;

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
