// .npy files come back as they were written, and lie in the file as NumPy expects them.
#include <fstream>
#include <iterator>
#include <limits>

#include <catch2/catch.hpp>

#include "tests/tools/temporary_folder.hpp"
#include "tools/common/npy.hpp"

using namespace gvom::npy;
using gvom::test::TemporaryFolder;

namespace {

struct Voxel {
  std::int32_t x;
  std::uint32_t hits;
  float min_height;
};
const std::vector<Field> kVoxelFields{{"x", "<i4"}, {"hits", "<u4"}, {"min_height", "<f4"}};

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

TEST_CASE("a plain array keeps shape, type and values") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.npy";
  const std::vector<float> heights{1.5F, -2.0F, 0.0F, std::numeric_limits<float>::infinity(), 4.0F, 5.0F};
  REQUIRE(write_npy(path, {2, 3}, heights.data()));
  const auto array = read_npy(path);
  REQUIRE(array);
  CHECK(array->shape == std::vector<std::size_t>{2, 3});
  CHECK(array->values<float>().value() == heights);
  CHECK(array->values<std::int32_t>().error() == "holds <f4, expected <i4");
}

TEST_CASE("the header is NumPy's, padded so that the data is aligned") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.npy";
  const std::vector<std::uint8_t> values{7, 8, 9};
  REQUIRE(write_npy(path, {3}, values.data()));
  const std::string bytes = read_file(path);
  CHECK(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  CHECK(bytes.substr(10, 60) == "{'descr': '|u1', 'fortran_order': False, 'shape': (3,), }   ");
  CHECK(bytes.size() == 128 + 3);
  CHECK(bytes.substr(127) == "\n\x07\x08\x09");
}

TEST_CASE("records keep their fields' names and types") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/voxels.npy";
  const std::vector<Voxel> voxels{{-3, 2, 0.5F}, {4, 0, std::numeric_limits<float>::infinity()}};
  REQUIRE(write_npy_records(path, kVoxelFields, voxels));
  const auto array = read_npy(path);
  REQUIRE(array);
  CHECK(array->shape == std::vector<std::size_t>{2});
  CHECK(array->describe_type() == "x <i4, hits <u4, min_height <f4");
  const auto read = array->records<Voxel>(kVoxelFields);
  REQUIRE(read);
  CHECK(read->at(0).x == -3);
  CHECK(read->at(0).hits == 2);
  CHECK(read->at(1).min_height == std::numeric_limits<float>::infinity());
  CHECK_FALSE(array->records<Voxel>({{"y", "<i4"}, {"hits", "<u4"}, {"min_height", "<f4"}}));
}

TEST_CASE("a record with padding is refused, not written shifted") {
  struct Padded {
    std::uint8_t a;
    std::int32_t b;
  };
  const TemporaryFolder folder;
  const std::vector<Padded> records(1);
  CHECK_FALSE(write_npy_records(folder.path() + "/a.npy", {{"a", "|u1"}, {"b", "<i4"}}, records));
}

TEST_CASE("an empty array and a scalar are arrays too") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.npy";
  const double value = 2.5;
  REQUIRE(write_npy<double>(path, {0, 4}, nullptr));
  CHECK(read_npy(path)->values<double>()->empty());
  REQUIRE(write_npy(path, {}, &value));
  CHECK(read_npy(path)->shape.empty());
  CHECK(read_npy(path)->values<double>().value() == std::vector<double>{2.5});
}

TEST_CASE("what cannot be read is an error that names the file and the reason") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/a.npy";
  CHECK(read_npy(path).error() == path + ": cannot be opened");

  write_file(path, "PNG or so");
  CHECK(read_npy(path).error() == path + ": not an .npy file");

  const std::vector<float> values(4);
  REQUIRE(write_npy(path, {2, 2}, values.data()));
  const std::string good = read_file(path);
  write_file(path, good.substr(0, good.size() - 1));
  CHECK(read_npy(path).error() == path + ": has 15 bytes of data, its shape needs 4 x 4");
  write_file(path, good.substr(0, 40));
  CHECK(read_npy(path).error() == path + ": the header is cut off");

  std::string fortran = good;
  fortran.replace(fortran.find("False"), 5, "True ");
  write_file(path, fortran);
  CHECK(read_npy(path).error() == path + ": Fortran order is not supported");

  std::string big_endian = good;
  big_endian.replace(big_endian.find("<f4"), 3, ">f4");
  write_file(path, big_endian);
  CHECK(read_npy(path).error() == path + ": type >f4 is not supported");
  CHECK_FALSE(write_npy(folder.path() + "/none/a.npy", {2, 2}, values.data()));
}
