// Drives through real scenes: few maps of few beams, enough to see that the whole chain says the same every
// time.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/tools/temporary_folder.hpp"
#include "tools/evaluation/options.hpp"
#include "tools/evaluation/report.hpp"

using namespace gvom::evaluation;
using gvom::test::TemporaryFolder;

namespace {

Options small() {
  Options options;
  options.scenes = {"flat", "walker"};
  options.sensors = {"vlp-16"};
  options.frames = 6;
  return options;
}

tl::expected<std::vector<Row>, std::string> evaluate(const Options& options) {
  const auto plan = make_plan(options);
  REQUIRE(plan);
  return run(*plan, [](int, int, const std::string&, double) {});
}

std::string csv(const Options& options) {
  const auto rows = evaluate(options);
  REQUIRE(rows);
  return to_csv(*rows, "");
}

}  // namespace

TEST_CASE("a flat field is mapped without faults, and its height is right to millimetres") {
  Options options = small();
  options.scenes = {"flat"};
  const auto rows = evaluate(options);
  REQUIRE(rows);
  REQUIRE(rows->size() == 1);
  const Figures& figures = rows->front().figures;
  CHECK(rows->front().name() == "flat vlp-16 trail");
  CHECK(figures[Figure::lethal_any] == 0.0);
  CHECK(figures[Figure::path_barred_30] == 0.0);
  CHECK(std::abs(figures[Figure::bare_near_bias]) < 0.02);
  CHECK(figures[Figure::bare_p95] < 0.05);
  CHECK(figures[Figure::coverage_near] > 50.0);
}

TEST_CASE("the figures do not depend on threads, nor on whether sweeps come from the cache") {
  const TemporaryFolder folder;
  Options options = small();
  options.threads = 1;
  const std::string expected = csv(options);
  options.threads = 2;
  CHECK(csv(options) == expected);
  options.cache = folder.path() + "/cache";
  CHECK(csv(options) == expected);
  CHECK(std::distance(std::filesystem::directory_iterator(options.cache), {}) == 2);
  CHECK(csv(options) == expected);

  // What is read is what the files hold.
  for (const auto& file : std::filesystem::directory_iterator(options.cache)) {
    const auto size = std::filesystem::file_size(file);
    std::ofstream(file.path(), std::ios::binary) << std::string(size, '\0');
  }
  CHECK(csv(options) != expected);
}

TEST_CASE("a cached file that was cut off is refused by name") {
  const TemporaryFolder folder;
  Options options = small();
  options.scenes = {"flat"};
  options.cache = folder.path();
  csv(options);
  const auto file = std::filesystem::directory_iterator(folder.path())->path();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  CHECK(evaluate(options).error() ==
        "flat vlp-16 trail: " + file.string() + ": is shorter than it was written; delete it");
}

TEST_CASE("another seed makes other sweeps") {
  Options options = small();
  options.scenes = {"walker"};
  const std::string first = csv(options);
  options.seed = 2;
  CHECK(csv(options) != first);
}

TEST_CASE("a picture of each scene") {
  const TemporaryFolder folder;
  Options options = small();
  options.pictures = folder.path() + "/pictures";
  csv(options);
  CHECK(std::filesystem::file_size(options.pictures + "/flat.png") > 10'000);
  CHECK(std::filesystem::exists(options.pictures + "/walker.png"));
}

TEST_CASE("the plan: all scenes and sensors, a fast drive beside, unless told otherwise") {
  const auto all = make_plan({});
  REQUIRE(all);
  CHECK(all->scenes.size() == gvom::sim::scene_library().size());
  REQUIRE(all->drives.size() == 2);
  CHECK(all->drives[0].sensors.size() == 3);
  CHECK(all->drives[1].speed_mps == 12.0);
  CHECK(all->drives[1].odometry_noise.rotation_rad == 0.002);
  CHECK(all->vehicle.lidars[0].T_base_sensor.translation().z() == 1.7);

  Options options;
  options.quick = true;
  const auto quick = make_plan(options);
  REQUIRE(quick);
  CHECK(quick->scenes.size() == 8);
  CHECK(quick->drives.size() == 1);
  options.noise = {0.01, 0.001};
  CHECK(settings_of(*make_plan(options), options) ==
        "seed 1, frames 40, trail at 5 m/s, odometry off by 0.01 m and 0.001 rad");
}

TEST_CASE("what there is not is refused by name") {
  Options options;
  options.scenes = {"flatt"};
  CHECK(make_plan(options).error().find("flatt") != std::string::npos);
  options = {};
  options.sensors = {"os9"};
  CHECK(make_plan(options).error().find("os9") != std::string::npos);
  options = {};
  options.sets = {"layers.min_hits=2"};
  CHECK(make_plan(options).error() == "--set needs --vehicle");
  options.vehicle = "no.yaml";
  CHECK(make_plan(options).error().find("no.yaml") != std::string::npos);
}

TEST_CASE("a vehicle's file has its lidars and its parameters") {
  Options options;
  options.vehicle = GVOM_SOURCE_DIR "/config/vehicles/two_lidars.yaml";
  options.sets = {"layers.min_hits=3"};
  const auto plan = make_plan(options);
  REQUIRE(plan);
  CHECK(plan->vehicle.lidars.size() == 2);
  CHECK(plan->vehicle.mapper.layers.min_hits == 3);
}
