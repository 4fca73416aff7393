// How many floats a point of a .bin has: found out where it is beyond doubt, else asked for.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "services/ingest/bin_floats.hpp"
#include "tests/ingest/scan_builder.hpp"

using namespace gvom;
using namespace gvom::test;
using Kind = ingest::FloatsJudgement::Kind;

namespace {

std::vector<float> floats_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<float> values(std::filesystem::file_size(path) / sizeof(float));
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  return values;
}

ingest::FloatsJudgement judge(const std::vector<float>& values) {
  return ingest::judge_floats(
      {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(float)});
}

/// Around a sensor 1.7 m above the ground, in any order: x y z, an intensity, a ring, and zeros.
std::vector<float> points(std::size_t count, std::size_t floats, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-40, 40), height(-2, 3), intensity(0, 255);
  std::vector<float> out;
  for (std::size_t i = 0; i < count; ++i) {
    const float all[] = {place(random),
                         place(random),
                         height(random),
                         std::floor(intensity(random)),
                         static_cast<float>(random() % 32),
                         0,
                         0,
                         0};
    out.insert(out.end(), all, all + floats);
  }
  return out;
}

}  // namespace

TEST_CASE("how many floats a point has is seen in the values, in whatever order the points are") {
  for (std::size_t floats = 3; floats <= 7; ++floats) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
      const auto judgement = judge(points(100 + 37 * seed, floats, seed));
      REQUIRE(judgement.kind == Kind::found);
      REQUIRE(judgement.floats == floats);
    }
  }
  CHECK(judge(points(20, 5)).kind == Kind::unknown);
  CHECK(judge(std::vector<float>(10000)).empty);
}

TEST_CASE("a .bin is read by the number of floats that was found") {
  TemporaryFolder folder;
  for (const std::size_t floats : {4, 5, 6}) {
    const auto values = points(400, floats);  // 400 * 4 * floats is a multiple of 16, 20 and 24
    const std::string path = folder.path() + "/a.bin";
    write(path, bin(values));
    const auto source = open("scans:" + path);
    const Sweep sweep = all_sweeps(*source).at(0);
    REQUIRE(sweep.returns.size() == 400);
    for (std::size_t i = 0; i < 400; ++i) REQUIRE(sweep.returns[i].z_m == values[i * floats + 2]);
    CHECK(source->warnings().size() == (floats == 4 ? 1 : 2));
    if (floats != 4)
      CHECK(source->warnings()[1].find("?floats=" + std::to_string(floats)) != std::string::npos);
  }
}

TEST_CASE("what cannot be told is refused and names the option, which is believed") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.bin";
  write(path, bin(points(4, 5)));  // 80 bytes
  CHECK(open_error("scans:" + path)
            .find(path + ": too few points to tell how many floats each has: say "
                         "scans:PATH?floats=4") == 0);
  CHECK(all_sweeps(*open("scans:" + path + "?floats=5")).at(0).returns.size() == 4);
  CHECK(all_sweeps(*open("scans:" + path + "?floats=4")).at(0).returns.size() == 5);
  write(path, bin(points(400, 3)));
  CHECK(open_error("scans:" + path).find("looks like 3 floats a point") != std::string::npos);
  write(path, bin(points(400, 5)));
  const auto told = open("scans:" + path + "?floats=4");
  CHECK(all_sweeps(*told).at(0).returns.size() == 500);
  CHECK(told->warnings().back() == path + ": read as it was asked, but looks like 5 floats a point, not 4");
  CHECK(open_error("scans:" + path + "?floats=3").find("expected 4, 5 or 6") != std::string::npos);
  ByteVector bytes;  // in no format
  std::mt19937 random(1);
  for (int i = 0; i < 960; ++i) put_le(bytes, static_cast<std::uint32_t>(random()));
  write(path, bytes);
  CHECK(open_error("scans:" + path).find("does not look like points") != std::string::npos);
}

TEST_CASE("sizes tell where the values are too few") {
  TemporaryFolder folder;
  write(folder.path() + "/0.bin", bin(points(4, 5)));
  write(folder.path() + "/1.bin", bin(points(3, 5)));
  CHECK(all_sweeps(*open("scans:" + folder.path())).at(0).returns.size() == 4);
}

TEST_CASE("a file of another kind among the others is refused, and doubles are") {
  TemporaryFolder folder;
  write(folder.path() + "/0.bin", bin(points(400, 4)));
  write(folder.path() + "/1.bin", bin(points(400, 5)));
  const auto source = open("scans:" + folder.path());
  Sweep sweep;
  REQUIRE(source->next(sweep, std::chrono::milliseconds(0)).has_value());
  const auto event = source->next(sweep, std::chrono::milliseconds(0));
  REQUIRE_FALSE(event.has_value());
  CHECK(event.error().find("1.bin: looks like 5 floats a point, not 4: say scans:PATH?floats=") !=
        std::string::npos);

  TemporaryFolder doubles;
  ByteVector bytes;
  for (const float value : points(30, 4)) put_le(bytes, static_cast<double>(value));
  write(doubles.path() + "/0.bin", bytes);
  auto of_doubles = ingest::open_source("scans:" + doubles.path(), {});
  if (of_doubles) CHECK_FALSE((*of_doubles)->next(sweep, std::chrono::milliseconds(0)).has_value());
}

TEST_CASE("real scans are read as what they are, also shuffled, cut to a piece, and without intensities") {
  const auto data = recordings();
  if (!data) return;
  const std::string nuscenes = *data + "/field/nuscenes_5float_bin";
  std::vector<std::pair<std::string, std::size_t>> files;
  for (const std::string& folder : {*data + "/kitti_drive0005/velodyne", *data + "/rellis_offroad",
                                    *data + "/field/scan_order_1_10_2", nuscenes}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".bin") files.emplace_back(entry.path(), folder == nuscenes ? 5 : 4);
  }
  REQUIRE(files.size() >= 23);
  for (const auto& [path, floats] : files) {
    INFO(path);
    const auto is_found = [floats = floats](const std::vector<float>& values) {
      const auto judgement = judge(values);
      return judgement.kind == Kind::found && judgement.floats == floats;
    };
    const std::vector<float> values = floats_of(path);
    CHECK(is_found(values));
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2 / floats * floats);
    CHECK(is_found({begin, begin + static_cast<std::ptrdiff_t>(300 * floats)}));
    std::vector<float> plain = values;
    for (std::size_t i = 3; i < plain.size(); i += floats) plain[i] = 0;
    CHECK(is_found(plain));
    for (std::size_t i = values.size() / floats; i > 1; --i) {
      const std::size_t other = (i * 2654435761U) % i;
      if (other + 1 == i) continue;
      std::swap_ranges(plain.begin() + static_cast<std::ptrdiff_t>((i - 1) * floats),
                       plain.begin() + static_cast<std::ptrdiff_t>(i * floats),
                       plain.begin() + static_cast<std::ptrdiff_t>(other * floats));
    }
    CHECK(is_found(plain));
  }
  const auto source = open("scans:" + nuscenes);
  const Sweep sweep = all_sweeps(*source).at(0);
  CHECK(sweep.returns.size() == 693760 / 20);
  CHECK(std::all_of(sweep.returns.begin(), sweep.returns.end(),
                    [](const Return& r) { return std::abs(r.z_m) < 50; }));
}
