// One file for each sweep: .bin and .pcd, with times or without.
#include <liblzf/lzf.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

namespace {

std::string write(const std::string& path, const ByteVector& bytes) {
  return write_text(path, std::string(bytes.begin(), bytes.end()));
}

ByteVector bin(const std::vector<float>& values) {
  ByteVector out;
  for (const float value : values) put_le(out, value);
  return out;
}

std::string header(const std::string& fields, const std::string& sizes, const std::string& types, int points,
                   const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
         "\nDATA " + data + "\n";
}

ByteVector joined(const std::string& text, const ByteVector& body) {
  ByteVector out(text.begin(), text.end());
  append(out, body);
  return out;
}

Sweep only_sweep(const std::string& path) {
  auto source = open("scans:" + path);
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 1);
  return sweeps[0];
}

/// The error of reading the only file.
std::string read_error(const std::string& path) {
  auto source = open("scans:" + path);
  Sweep sweep;
  const auto event = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(event.has_value());
  CHECK(event.error().find(path) == 0);
  CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kEnd);
  return event.error();
}

}  // namespace

TEST_CASE("a .bin holds float32 x y z intensity; zeros and NaN stay returns") {
  TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write(folder.path() + "/b.bin", bin({0, 0, 0, 0, nan, 1, 2, 0}));
  write(folder.path() + "/a.bin", bin({1.5F, -2, 3, 0.5F}));
  write_text(folder.path() + "/times.txt", "1000000000.000000001\n1000000000.1\n\n");
  auto source = open("scans:" + folder.path());
  const auto sweeps = all_sweeps(*source);
  REQUIRE(sweeps.size() == 2);
  CHECK(source->warnings().empty());
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
  CHECK(error_of("1\n1\n").find("times.txt:2: time does not go forward") != std::string::npos);
  CHECK(error_of("1\nnan\n").find("times.txt:2: 'nan' is not a time") != std::string::npos);
  CHECK(error_of("1\n2\n3\n").find("times.txt:3: a time too many: there are 2 scans") != std::string::npos);
  CHECK(error_of("1\n").find("times.txt: 1 times for 2 scans, none for " + folder.path() + "/1.bin") !=
        std::string::npos);
}

TEST_CASE("paths that hold no scans are refused") {
  TemporaryFolder folder;
  CHECK(open_error("scans:" + folder.path() + "/none").find("no such file or folder") != std::string::npos);
  CHECK(open_error("scans:" + folder.path()).find("no .bin or .pcd files") != std::string::npos);
  CHECK(open_error("scans:" + write_text(folder.path() + "/a.txt", "")).find("neither") != std::string::npos);
  write(folder.path() + "/a.bin", {});
  write(folder.path() + "/a.pcd", {});
  CHECK(open_error("scans:" + folder.path()).find("holds .bin and .pcd") != std::string::npos);
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

TEST_CASE("binary PCD: times in seconds, relative or of the clock") {
  TemporaryFolder folder;
  ByteVector body;
  for (const double time : {0.05, 1.5e9}) {
    for (const float value : {1.F, 2.F, 3.F}) put_le(body, value);
    put_le(body, time);
  }
  write(folder.path() + "/a.pcd", joined(header("x y z time", "4 4 4 8", "F F F F", 2, "binary"), body));
  write_text(folder.path() + "/times.txt", "10\n");
  const Sweep sweep = only_sweep(folder.path());
  CHECK(sweep.times_ns == std::vector<std::int64_t>{10'050'000'000, 1'500'000'000'000'000'000});
}

TEST_CASE("compressed PCD: one array a field") {
  TemporaryFolder folder;
  constexpr int kPoints = 100;
  ByteVector arrays;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kPoints; ++i) put_le(arrays, static_cast<float>(axis * 1000 + i / 10));
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
  CHECK(sweep.returns[57].y_m == 1005);
  CHECK(sweep.returns[57].z_m == 2005);

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
  CHECK(
      error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 three\n").find("point 0: z is 'three'") !=
      std::string::npos);
  CHECK(error_of(header("x y z", "4 4 4", "F F F", 1, "base64")).find("DATA base64 is not known") !=
        std::string::npos);
  CHECK(error_of(header("x y z t", "4 4 4 4", "F F F F", 1, "ascii") + "1 2 3 nan\n")
            .find("point 0: 't' is not a time") != std::string::npos);
}
