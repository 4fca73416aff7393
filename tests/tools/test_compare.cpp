// What differs between arrays is told so that no second run is needed: which, how many, where, by what.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>

#include "tests/tools/temporary_folder.hpp"
#include "tools/compare/folders.hpp"
#include "tools/compare/maps.hpp"

namespace gvom::test {
namespace {

using compare::difference;
using compare::Same;
using compare::view_of;

// A folder as gvom-map writes it, with two arrays in each of two maps.
void write_maps(const std::string& folder) {
  std::vector<float> heights(6, 0.25F);
  const std::vector<std::uint8_t> costs{0, 1, 2, 253, 254, 255};
  for (const char* map : {"/000000", "/000001"}) {
    std::filesystem::create_directories(folder + map);
    REQUIRE(npy::write_npy(folder + map + "/height.npy", {2, 3}, heights.data()));
    REQUIRE(npy::write_npy(folder + map + "/cost.npy", {2, 3}, costs.data()));
  }
}

TEST_CASE("of floats the bits are told, of an array its indices") {
  const std::vector<float> expected{1, 2, 0.25F, 4, 5, 6};
  std::vector<float> found = expected;
  CHECK(difference("height", view_of({2, 3}, expected.data()), view_of({2, 3}, found.data())) == "");
  found[2] = std::nextafter(0.25F, 1.0F);
  found[3] = std::numeric_limits<float>::quiet_NaN();
  CHECK(difference("height", view_of({2, 3}, expected.data()), view_of({2, 3}, found.data())) ==
        "height: 2 of 6 differ\n"
        "  [0, 2]: expected 0.25 = 0x3e800000, found 0.25000003 = 0x3e800001\n"
        "  [1, 0]: expected 4 = 0x40800000, found nan = 0x7fc00000");
}

TEST_CASE("the first ten are told, and all are counted") {
  std::vector<std::int32_t> expected(100);
  std::iota(expected.begin(), expected.end(), -3);
  std::vector<std::int32_t> found = expected;
  for (std::size_t i = 50; i < 100; ++i) --found[i];
  const std::string words =
      difference("lookup", view_of({100}, expected.data()), view_of({100}, found.data()));
  CHECK(words.find("lookup: 50 of 100 differ\n  [50]: expected 47, found 46\n") == 0);
  CHECK(std::count(words.begin(), words.end(), '\n') == 10);
  CHECK(words.find("[59]") != std::string::npos);
  CHECK(words.find("[60]") == std::string::npos);
}

TEST_CASE("whole numbers of each width keep their sign") {
  const std::int8_t small[] = {-1, 0};
  const std::int64_t large[] = {INT64_MIN, 0};
  const std::uint64_t bits[] = {UINT64_MAX, 0};
  CHECK(difference("a", view_of({1}, small), view_of({1}, small + 1)).find("expected -1, found 0") !=
        std::string::npos);
  CHECK(
      difference("a", view_of({1}, large), view_of({1}, large + 1)).find("expected -9223372036854775808,") !=
      std::string::npos);
  CHECK(difference("a", view_of({1}, bits), view_of({1}, bits + 1)).find("expected 18446744073709551615,") !=
        std::string::npos);
}

TEST_CASE("one NaN is another only where values are compared, not bytes") {
  const float one[] = {std::numeric_limits<float>::quiet_NaN()};
  const float other[] = {-std::numeric_limits<float>::quiet_NaN()};
  CHECK(difference("a", view_of({1}, one), view_of({1}, other), Same::values) == "");
  CHECK(difference("a", view_of({1}, one), view_of({1}, other), Same::bytes) != "");
  const float zeros[] = {0.0F, -0.0F};
  CHECK(difference("a", view_of({1}, zeros), view_of({1}, zeros + 1), Same::values) != "");
}

TEST_CASE("another type or shape is told; lists are compared as far as both reach") {
  const float floats[] = {1, 2, 3};
  const std::int32_t whole[] = {1, 2, 3};
  CHECK(difference("a", view_of({3}, floats), view_of({3}, whole)) == "a: type is <i4, expected <f4");
  CHECK(difference("a", view_of({1, 3}, floats), view_of({3, 1}, floats)) ==
        "a: shape is [3, 1], expected [1, 3]");
  CHECK(difference("a", view_of({3}, whole), view_of({2}, whole)) ==
        "a: shape is [2], expected [3]; the same as far as both reach");
  CHECK(difference("a", view_of({2}, whole), view_of({2}, whole + 1)) ==
        "a: 2 of 2 differ\n  [0]: expected 1, found 2\n  [1]: expected 2, found 3");
}

TEST_CASE("of maps each array is compared, of records each field is told") {
  const std::int32_t directory[] = {0};
  std::vector<std::int32_t> lookup(kBrickCells, -1);
  const std::uint64_t columns[] = {1};
  const VoxelRecord record{2, 3, 0.5F};
  BrickMapView expected;
  expected.shape = {1, 1, 1};
  expected.directory = directory;
  expected.lookup = lookup.data();
  expected.columns = columns;
  expected.records = &record;
  CHECK(compare::map_difference(expected, expected) == "");
  const VoxelRecord other{2, 4, 0.5F};
  const std::uint64_t other_columns[] = {3};
  BrickMapView found = expected;
  found.records = &other;
  found.columns = other_columns;
  CHECK(compare::map_difference(expected, found) ==
        "columns: 1 of 1 differ\n  [0]: expected 1, found 3\n"
        "records: 1 of 1 differ\n  [0]: expected hits 2 passes 3 min_height_m 0.5 = 0x3f000000, found hits 2 "
        "passes 4 min_height_m 0.5 = 0x3f000000");
}

TEST_CASE("folders are the same, or what differs is told, missing and unexpected arrays too") {
  const TemporaryFolder folder;
  const std::string expected = folder.path() + "/expected", found = folder.path() + "/found";
  write_maps(expected);
  write_maps(found);
  auto same = compare::compare_folders(expected, found, {});
  REQUIRE(same);
  CHECK(compare::report(*same) == "4 arrays, the same byte for byte\n");

  const std::vector<std::uint8_t> costs{0, 1, 2, 253, 254, 254};
  REQUIRE(npy::write_npy(found + "/000001/cost.npy", {2, 3}, costs.data()));
  std::filesystem::rename(found + "/000000/height.npy", found + "/000000/depth.npy");
  const auto other = compare::compare_folders(expected, found, {});
  REQUIRE(other);
  CHECK(compare::report(*other) ==
        "3 of 4 arrays are not as expected\n"
        "000000/depth.npy: was not expected\n"
        "000000/height.npy: is missing\n"
        "000001/cost.npy: 1 of 6 differ\n  [1, 2]: expected 255, found 254\n");
  CHECK(compare::compare_folders(expected, found, {"cost.npy", "depth.npy", "height.npy"})->arrays == 0);
  CHECK_FALSE(compare::compare_folders(expected, folder.path() + "/none", {}));
}

TEST_CASE("many differences are a few in full, some in short, and how many more") {
  compare::FolderComparison comparison;
  comparison.arrays = 50;
  for (int i = 0; i < 40; ++i)
    comparison.differences.push_back(std::to_string(i) + ".npy: 1 of 1 differ\n  [0]: 1, 2");
  const std::string words = compare::report(comparison);
  CHECK(words.find("40 of 50 arrays are not as expected\n0.npy: 1 of 1 differ\n  [0]: 1, 2\n") == 0);
  CHECK(words.find("\n10.npy: 1 of 1 differ\n11.npy") != std::string::npos);
  CHECK(words.find("\n... and 6 more\n") != std::string::npos);
}

int run_compare(const std::string& arguments) {
  const int status = std::system(("'" GVOM_COMPARE "' " + arguments + " > /dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_CASE("gvom-compare ends with 0 for the same, 1 for others, 65 for no arrays, 64 for a wrong command") {
  const TemporaryFolder folder;
  const std::string expected = folder.path() + "/expected", found = folder.path() + "/found";
  write_maps(expected);
  write_maps(found);
  CHECK(run_compare(expected + " " + found) == 0);
  std::filesystem::remove(found + "/000001/cost.npy");
  CHECK(run_compare(expected + " " + found) == 1);
  CHECK(run_compare(expected + " " + found + " --ignore cost.npy") == 0);
  std::filesystem::create_directories(folder.path() + "/empty");
  CHECK(run_compare(folder.path() + "/empty " + found) == 65);
  CHECK(run_compare(expected + " " + folder.path() + "/none") == 65);
  CHECK(run_compare(expected) == 64);
}

}  // namespace
}  // namespace gvom::test
