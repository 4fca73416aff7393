// How many floats a point of a .bin has: found out where it is beyond doubt, else asked for.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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

/// As they are fired: one laser below and one above in turn, in a room of 12 to 20 m on flat ground.
/// x y z, an intensity, a ring, a time.
std::vector<std::array<float, 6>> fired(const std::vector<double>& elevations_deg) {
  constexpr double kDegree = 3.14159265358979 / 180;
  constexpr int kColumns = 900;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  std::vector<std::array<float, 6>> out;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 360 * kDegree * column / kColumns;
    for (std::size_t ring = 0; ring < elevations_deg.size(); ++ring) {
      const double up = elevations_deg[ring] * kDegree;
      const double wall = (12 + 8 * std::abs(std::sin(3 * azimuth))) / std::cos(up);
      const double range = (up < 0 ? std::min(wall, 1.73 / std::sin(-up)) : wall) + noise(random);
      out.push_back({static_cast<float>(range * std::cos(up) * std::cos(azimuth)),
                     static_cast<float>(-range * std::cos(up) * std::sin(azimuth)),
                     static_cast<float>(range * std::sin(up)), static_cast<float>(random() % 100),
                     static_cast<float>(ring), static_cast<float>(column * 1e-4)});
    }
  }
  return out;
}

const std::vector<double> kVlp16 = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
const std::vector<double> kHdl32 = {-30.67, -9.33, -29.33, -8,    -28,    -6.67, -26.67, -5.33,
                                    -25.33, -4,    -24,    -2.67, -22.67, -1.33, -21.33, 0,
                                    -20,    1.33,  -18.67, 2.67,  -17.33, 4,     -16,    5.33,
                                    -14.67, 6.67,  -13.33, 8,     -12,    9.33,  -10.67, 10.67};

/// The first floats of each point.
std::vector<float> first_floats(const std::vector<std::array<float, 6>>& points, std::size_t floats) {
  std::vector<float> out;
  for (const auto& point : points) out.insert(out.end(), point.begin(), point.begin() + floats);
  return out;
}

/// Points of 8 floats: x y z, an intensity, and four more of a normal distribution.
std::vector<float> with_four_more(const std::vector<std::array<float, 6>>& points, float deviation) {
  std::mt19937 random(1);
  std::normal_distribution<float> more(0, deviation);
  std::vector<float> out;
  for (const auto& point : points) {
    out.insert(out.end(), point.begin(), point.begin() + 4);
    for (int i = 0; i < 4; ++i) out.push_back(more(random));
  }
  return out;
}

/// Each followed by one that is not a hit.
std::vector<std::array<float, 6>> every_second(const std::vector<std::array<float, 6>>& points, float value) {
  std::vector<std::array<float, 6>> out;
  for (const auto& point : points) {
    out.push_back(point);
    out.push_back({value, value, value, 0, 0, 0});
  }
  return out;
}

void check_found(const std::vector<float>& values, std::size_t floats) {
  const auto judgement = judge(values);
  CHECK(judgement.kind == Kind::found);
  CHECK(judgement.floats == floats);
}

}  // namespace

TEST_CASE("points that come in pairs are not taken for points of twice as many floats") {
  for (const auto& lasers : {kVlp16, kHdl32, {-7, 25}, {-7, 25, 3, 40}, {-3, 3, -6, 6, -9, 9, -12, 12}}) {
    INFO(lasers.size());
    const auto points = fired(lasers);
    check_found(first_floats(points, 4), 4);
    if (lasers.size() >= 16) check_found(first_floats(points, 5), 5);
    check_found(first_floats(every_second(points, 0), 4), 4);
    check_found(first_floats(every_second(points, NAN), 4), 4);
    check_found(with_four_more(points, 1), 8);
    check_found(with_four_more(points, 8), 8);  // such as velocities: as large as coordinates
  }
  std::vector<std::array<float, 6>> twice;
  for (auto point : fired(kVlp16)) {
    twice.push_back(point);
    point[3] = 0;
    twice.push_back(point);
  }
  check_found(first_floats(twice, 4), 4);
  check_found(first_floats(fired(kVlp16), 6), 6);
  std::vector<float> doubles;
  for (const float value : first_floats(fired(kVlp16), 4)) {
    const double precise = value * 1.0000001;
    float halves[2];
    std::memcpy(halves, &precise, sizeof precise);
    doubles.insert(doubles.end(), halves, halves + 2);
  }
  CHECK(judge(doubles).floats != 4);
}

TEST_CASE("pairs of points of three floats are not taken for points of six") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.bin";
  for (const auto& points : {fired(kVlp16), fired(kHdl32), every_second(fired(kVlp16), 0)}) {
    write(path, bin(first_floats(points, 3)));
    CHECK(open_error("scans:" + path)
              .find(path + ": looks like 3 or 6 floats a point: say scans:PATH?floats=4") == 0);
  }
}

TEST_CASE("coordinates that are not metres are refused, also where the number of floats is told") {
  TemporaryFolder folder;
  const std::string path = folder.path() + "/a.bin";
  for (const float unit : {100.0F, 1000.0F}) {
    auto values = first_floats(fired(kVlp16), 4);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (i % 4 != 3) values[i] *= unit;
    write(path, bin(values));
    for (const char* option : {"", "?floats=4"}) {
      const auto source = open("scans:" + path + option);
      Sweep sweep;
      const auto event = source->next(sweep, std::chrono::milliseconds(0));
      REQUIRE_FALSE(event.has_value());
      CHECK(event.error().find("hits are beyond 500 m: not metres?") != std::string::npos);
      CHECK(event.error().find("floats=") == std::string::npos);
    }
  }
}

TEST_CASE("scans without a hit are told of once") {
  for (const float value : {0.0F, NAN}) {
    TemporaryFolder folder;
    const auto hits = first_floats(fired(kVlp16), 4);
    write(folder.path() + "/0.bin", bin(hits));
    write(folder.path() + "/1.bin", bin(std::vector<float>(4000, value)));
    write(folder.path() + "/2.bin", {});
    const auto source = open("scans:" + folder.path() + "?floats=4");
    CHECK(all_sweeps(*source).size() == 3);
    const auto warnings = source->warnings();
    CHECK(std::count_if(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("1.bin: no hit in the whole scan") != std::string::npos;
          }) == 1);
    CHECK(std::none_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("2.bin") != std::string::npos;
    }));
  }
}

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
