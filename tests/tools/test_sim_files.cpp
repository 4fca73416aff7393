// Worlds as files: what is written reads back as the same world; what a surveyor writes is what stands there;
// what is wrong is said.
#include <cmath>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>

#include "tests/tools/sim_worlds.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/common/npy.hpp"
#include "tools/sim/scenes/trail.hpp"
#include "tools/sim/simulate.hpp"
#include "tools/sim/world_files.hpp"

using namespace gvom::sim;
using namespace gvom::test;

namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A level ground of 41 x 41 nodes of 1 m at 2 m, with the objects.json given.
tl::expected<WorldData, std::string> read_text(const std::string& folder, const std::string& objects_json) {
  const std::vector<float> heights(41 * 41, 2.0F);
  REQUIRE(gvom::npy::write_npy(folder + "/ground.npy", {41, 41}, heights.data()));
  std::ofstream(folder + "/objects.json") << objects_json;
  return read_world(folder);
}

std::string with_objects(const std::string& objects) {
  return R"({"resolution_m": 1, "min_x_m": -20, "min_y_m": -20, "path_m": [[0, 0], [10, 0]], "objects": [)" +
         objects + "]}";
}

std::string record(const WorldData& data) {
  const TemporaryFolder folder;
  gvom::services::VehicleConfig vehicle;
  vehicle.lidars.resize(1);
  vehicle.lidars[0].name = "top";
  vehicle.lidars[0].geometry.T_base_sensor = Eigen::Translation3d(0.0, 0.0, 1.7);
  RecordingOptions options;
  options.seconds = 0.2;
  options.threads = 2;
  const World world(data);
  REQUIRE(simulate(vehicle, world, options, folder.path()));
  std::string all;
  for (const char* name : {"top.pcap", "odometry.tum", "truth.json", "class.npy", "lethal.npy"})
    all += read_file(folder.path() + "/" + name);
  return all;
}

}  // namespace

TEST_CASE("a world that was saved and read back gives the same recording, byte for byte") {
  const TemporaryFolder folder;
  WorldData data = make_trail({3, 20.0, 5.0});
  data.rain_hits_per_m = 0.001;
  add(data, Kind::car, box({8.1, -4.3, 0.7}, {2.03, 0.81, 0.507}, 0.3), 1.2);
  Body egg = box({9.0, 5.0, 0.7}, {1.1, 0.4, 0.5}, 1.0 / 3.0);
  egg.shape = Body::Shape::ellipsoid;
  add(data, Kind::dust, egg, 1.2, 1.0 / 7.0);
  paint(data, {3.0, -1.0}, {4.0, 1.0}, Surface::mirror, 0.1);
  REQUIRE(save_world(data, folder.path() + "/world"));
  const auto back = read_world(folder.path() + "/world");
  if (!back) FAIL(back.error());
  CHECK(back->name == "trail");
  CHECK(back->objects.size() == data.objects.size());
  CHECK(record(*back) == record(data));
  REQUIRE(save_world(*back, folder.path() + "/again"));
  CHECK(read_file(folder.path() + "/again/objects.json") == read_file(folder.path() + "/world/objects.json"));
}

TEST_CASE("short forms stand on the ground") {
  const TemporaryFolder folder;
  const auto world = read_text(folder.path(), with_objects(R"(
    {"kind": "tree", "shape": "trunk", "x_m": 3, "y_m": 2, "radius_m": 0.2, "height_m": 5},
    {"kind": "rock", "shape": "sphere", "x_m": 6, "y_m": 2, "radius_m": 0.5},
    {"kind": "car", "shape": "block", "x_m": 9, "y_m": 4, "above_m": 0.2, "length_m": 4, "width_m": 1.8, "height_m": 1.3,
     "yaw_rad": 1.5707963267948966},
    {"kind": "bush", "shape": "sphere", "x_m": 3, "y_m": -4, "above_m": 0.5, "radius_m": 1, "hits_per_m": 0.1},
    {"kind": "tree", "bodies": [
      {"shape": "trunk", "x_m": 5, "y_m": -5, "radius_m": 0.2, "height_m": 5},
      {"shape": "sphere", "x_m": 5, "y_m": -5, "above_m": 4, "radius_m": 1.5, "hits_per_m": 0.35}]},
    {"kind": "branch", "bodies": [{"shape": "capsule", "from_m": [8, -3, 3.5], "to_m": [8, 3, 3.5], "radius_m": 0.1}]},
    {"kind": "walker", "track_s_m": [[0, 5, 5], [10, 5, -5]]})"));
  if (!world) FAIL(world.error());
  const auto& objects = world->objects;
  REQUIRE(objects.size() == 7);
  CHECK((objects[0].position_m - Eigen::Vector3d(3, 2, 2)).norm() < 1e-9);
  CHECK(objects[0].height_m == Approx(5.0));
  CHECK(objects[0].radius_m == Approx(0.2));
  CHECK(objects[1].height_m == Approx(0.5));
  CHECK(objects[2].height_m == Approx(1.5));
  CHECK(objects[3].bodies[0].hits_per_m == 0.1);
  CHECK(objects[4].height_m == Approx(5.5));
  CHECK(objects[4].radius_m == Approx(0.2));
  CHECK(objects[5].height_m == Approx(1.4));
  CHECK(objects[6].height_m == 1.8);

  const World cast_in(*world);
  const auto range = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
    return cast_in.cast({from, along}, {}, 100.0, 1).range_m;
  };
  CHECK(range({0, 2, 3}, {1, 0, 0}) == Approx(2.8));     // the trunk
  CHECK(range({6, 2, 8}, {0, 0, -1}) == Approx(5.5));    // the rock's top, 0.5 m above the ground
  CHECK(range({9, 4, 8}, {0, 0, -1}) == Approx(4.5));    // the car's roof, 1.5 m above it
  CHECK(range({9.95, 0, 3}, {0, 1, 0}) > 50.0);          // beside the car, 1.8 m wide along x
  CHECK(range({9.85, 0, 3}, {0, 1, 0}) == Approx(2.0));  // its front, 4 m long along y
}

TEST_CASE("what is wrong with a world is said with file, object, key and reason") {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/objects.json: ";
  const auto error = [&](const std::string& text) {
    const auto world = read_text(folder.path(), text);
    return world ? "nothing" : world.error();
  };
  const auto object_error = [&](const std::string& object) { return error(with_objects(object)); };
  CHECK(object_error("") == "nothing");
  CHECK(object_error(R"({"kind": "tree", "shape": "trunk", "x_m": 1, "y_m": 1, "radius_m": 0.2})") ==
        file + "object 0: \"height_m\" is missing");
  CHECK(object_error(R"({"kind": "elf", "shape": "trunk"})") ==
        file + "object 0: \"kind\": elf is none of tree, bush, grass, rock, wall, car, branch, walker, dust");
  CHECK(object_error(R"({"kind": "rock", "shape": "cone"})") ==
        file + "object 0: \"shape\": cone is none of capsule, ellipsoid, box, trunk, sphere, block");
  CHECK(
      object_error(R"({"kind": "rock", "bodies": [{"shape": "sphere", "x_m": 0, "y_m": 0, "radius": 1}]})") ==
      file + "object 0: body 0: unknown key \"radius\"");
  CHECK(object_error(R"({"kind": "rock", "shape": "sphere", "x_m": "3", "y_m": 0, "radius_m": 1})") ==
        file + "object 0: \"x_m\": expected a number of -100000 .. 100000");
  CHECK(object_error(R"({"kind": "rock", "shape": "sphere", "x_m": 300, "y_m": 0, "radius_m": 1})") ==
        file + "object 0 reaches more than 100 m beyond the ground");
  CHECK(object_error(R"({"kind": "walker", "track_s_m": [[1, 0, 0], [1, 2, 0]]})") ==
        file + "object 0: \"track_s_m\": its times must rise");
  CHECK(object_error(R"({"kind": "walker"})") == file + "object 0: \"track_s_m\" is missing");
  CHECK(object_error(R"({"kind": "rock"})") == file + "object 0: \"bodies\" is missing");
  CHECK(object_error(R"(3)") == file + "object 0: expected an object in braces");
  CHECK(error(R"({"resolution_m": 1, "min_x_m": 0, "min_y_m": 0})") == file + "\"path_m\" is missing");
  CHECK(error(R"({"resolution_m": 1, "min_x_m": 0, "min_y_m": 0, "path_m": [[1, 1], [50, 1]]})") ==
        file + "\"path_m\": corner 1 lies off the ground");
  CHECK(error(R"({"resolution_m": 1, "min_x_m": 0, "min_y_m": 0, "path_m": [[1, 1]]})") ==
        file + "\"path_m\": expected a path of 1 m to 10 km");
  CHECK(error(R"({"resolution_m": 0, "min_x_m": 0, "min_y_m": 0, "path_m": []})") ==
        file + "\"resolution_m\": expected a number of 0.01 .. 10");
  CHECK(error("{").find(file + "not JSON") == 0);
  CHECK(error(R"([1])") == file + "expected an object in braces");
}

TEST_CASE("a ground that is none is refused") {
  const TemporaryFolder folder;
  const auto error = [&] {
    const auto world = read_world(folder.path());
    return world ? "nothing" : world.error();
  };
  CHECK(error().find("ground.npy") != std::string::npos);
  std::vector<float> heights(41 * 41, 2.0F);
  heights[41 + 3] = std::numeric_limits<float>::quiet_NaN();
  REQUIRE(gvom::npy::write_npy(folder.path() + "/ground.npy", {41, 41}, heights.data()));
  CHECK(error() == folder.path() + "/ground.npy: the height at [1][3] is no number within 10000 m");
  REQUIRE(gvom::npy::write_npy(folder.path() + "/ground.npy", {41 * 41}, heights.data()));
  CHECK(error() == folder.path() + "/ground.npy: expected heights [y][x], at least 2 x 2");
  REQUIRE(read_text(folder.path(), with_objects("")));
  const std::vector<std::uint8_t> surface(41 * 41, 9);
  REQUIRE(gvom::npy::write_npy(folder.path() + "/surface.npy", {41, 41}, surface.data()));
  CHECK(error() == folder.path() + "/surface.npy: expected 0 ground, 1 hole, 2 face, 3 mirror, 4 dark");
  REQUIRE(gvom::npy::write_npy(folder.path() + "/surface.npy", {41, 40}, surface.data()));
  CHECK(error() == folder.path() + "/surface.npy: its shape is not that of ground.npy");
}
