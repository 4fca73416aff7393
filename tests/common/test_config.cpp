// What the loader takes and what it refuses, with the place, the key and the expectation in the message.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "services/common/config_file.hpp"
#include "tests/common/temporary_file.hpp"

namespace {

using namespace gvom;
using Catch::Contains;
using services::load_vehicle_config;
using Sets = std::vector<std::string>;

const std::string kMinimal =
    "name: v\n"
    "lidars:\n"
    "  top:\n"
    "    T_base_sensor: {x: 1, y: 2, z: 3, roll: 0, pitch: 0, yaw: 0}\n";

/// The error's text with FILE for the path.
std::string error_of(const std::string& yaml, const Sets& sets = {}) {
  const test::TemporaryFile file(yaml);
  const auto config = load_vehicle_config(file.path(), sets);
  if (config) return "no error";
  std::string text = config.error().text();
  for (std::size_t at; (at = text.find(file.path())) != std::string::npos;) {
    text.replace(at, file.path().size(), "FILE");
  }
  return text;
}

services::VehicleConfig loaded(const std::string& yaml, const Sets& sets = {}) {
  const test::TemporaryFile file(yaml);
  const auto config = load_vehicle_config(file.path(), sets);
  INFO((config ? "" : config.error().text()));
  REQUIRE(config);
  return *config;
}

}  // namespace

TEST_CASE("a minimal file leaves everything else at its default") {
  const auto config = loaded(kMinimal);
  CHECK(config.name == "v");
  CHECK(config.mapper.map.size_xy == MapConfig{}.size_xy);
  CHECK_FALSE(config.mapper.vehicle.body);
  REQUIRE(config.lidars.size() == 1);
  CHECK(config.lidars[0].name == "top");
  CHECK(config.lidars[0].geometry.T_base_sensor.translation() == Eigen::Vector3d(1, 2, 3));
  CHECK(config.lidars[0].geometry.T_base_sensor.linear() == Eigen::Matrix3d::Identity());
}

TEST_CASE("values of the file and of --set arrive in their fields") {
  const auto config =
      loaded(kMinimal + "map: {size_xy: 128, resolution_z_m: +0.5}\n",
             {"map.size_xy=64", "vehicle.body_min_m=[-1, -2, -3]", "vehicle.body_max_m=[1, 2, 3.5]",
              "lidars.top.source=ouster:a b.pcap?meta=c.json", "map.size_xy=32", "odometry.source="});
  CHECK(config.mapper.map.size_xy == 32);
  CHECK(config.mapper.map.resolution_z_m == 0.5);
  CHECK(config.lidars[0].source == "ouster:a b.pcap?meta=c.json");
  CHECK(config.odometry.source.empty());
  REQUIRE(config.mapper.vehicle.body);
  CHECK(config.mapper.vehicle.body->min_m == Eigen::Vector3d(-1, -2, -3));
  CHECK(config.mapper.vehicle.body->max_m == Eigen::Vector3d(1, 2, 3.5));
}

TEST_CASE("T_base_sensor turns about x, then y, then z of base_link") {
  const auto config = loaded(kMinimal, {"lidars.top.T_base_sensor.roll=1.5707963267948966",
                                        "lidars.top.T_base_sensor.yaw=1.5707963267948966"});
  const Eigen::Isometry3d& T_base_sensor = config.lidars[0].geometry.T_base_sensor;
  // Roll takes the sensor's y to z, which yaw leaves; roll leaves x, which yaw takes to y.
  CHECK((T_base_sensor.linear() * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm() < 1e-15);
  CHECK((T_base_sensor.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("positive pitch looks down") {
  const auto config = loaded(kMinimal, {"lidars.top.T_base_sensor.pitch=0.1"});
  const Eigen::Vector3d ahead = config.lidars[0].geometry.T_base_sensor.linear() * Eigen::Vector3d::UnitX();
  CHECK(ahead.z() == Approx(-std::sin(0.1)));
}

TEST_CASE("lidars are sorted by name") {
  const auto config = loaded(
      "name: v\nlidars:\n  b: {T_base_sensor: &t {x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}}\n"
      "  a: {T_base_sensor: *t}\n");
  REQUIRE(config.lidars.size() == 2);
  CHECK(config.lidars[0].name == "a");
  CHECK(config.lidars[1].name == "b");
}

TEST_CASE("unknown keys are refused, with the key that was probably meant") {
  CHECK(error_of(kMinimal + "map:\n  sice_xy: 256\n") ==
        "FILE:6: map.sice_xy: unknown key, did you mean map.size_xy?");
  CHECK(error_of(kMinimal + "mapp: {}\n") == "FILE:5: mapp: unknown key, did you mean map?");
  CHECK(error_of(kMinimal + "    max_rnge_m: 3\n") ==
        "FILE:5: lidars.top.max_rnge_m: unknown key, did you mean lidars.top.max_range_m?");
  CHECK(error_of(kMinimal + "completely_different: 1\n") == "FILE:5: completely_different: unknown key");
  CHECK_THAT(error_of(kMinimal + "map.size_xy: 8\n"), Contains("FILE:5: map.size_xy: unknown key"));
  CHECK_THAT(
      error_of(kMinimal, {"window.bufer_size=3"}),
      Contains(
          "--set window.bufer_size=3: window.bufer_size: unknown key, did you mean window.buffer_size?"));
}

TEST_CASE("repeated keys are refused") {
  CHECK(error_of(kMinimal + "name: w\n") == "FILE:5: name: repeated: expected once");
  CHECK(error_of("map:\n  size_z: 8\n  size_z: 8\n" + kMinimal) ==
        "FILE:3: map.size_z: repeated: expected once");
  CHECK_THAT(error_of(kMinimal + "  top: {}\n"), Contains("FILE:5: lidars.top: repeated"));
}

TEST_CASE("missing keys are refused") {
  CHECK_THAT(error_of("lidars: {}\n"), Contains("FILE: name: missing"));
  CHECK_THAT(error_of("name: v\n"), Contains("FILE: lidars: missing: expected 1 to 16 lidars"));
  CHECK_THAT(error_of("name: v\nlidars: {}\n"), Contains("FILE:2: lidars: missing"));
  CHECK(error_of("name: v\nlidars:\n  top:\n    T_base_sensor: {x: 0, y: 0, z: 0, roll: 0, pitch: 0}\n") ==
        "FILE:3: lidars.top.T_base_sensor.yaw: missing: expected a number in -6.2832 .. 6.2832");
  CHECK_THAT(error_of(kMinimal + "vehicle: {body_min_m: [0, 0, 0]}\n"),
             Contains("FILE:5: vehicle.body_max_m: missing: body_min_m is there"));
  CHECK_THAT(error_of(kMinimal, {"vehicle.body_max_m=[0, 0, 0]"}), Contains("vehicle.body_min_m: missing"));
}

TEST_CASE("a required key may come by --set") {
  const std::string without_yaw =
      "name: v\nlidars: {top: {T_base_sensor: {x: 0, y: 0, z: 0, roll: 0, pitch: 0}}}\n";
  CHECK(loaded(without_yaw, {"lidars.top.T_base_sensor.yaw=1"}).lidars[0].extrinsic.yaw_rad == 1.0);
}

TEST_CASE("wrong types are refused") {
  const std::string expected = "map.size_xy: expected a whole number in 8 .. 1024, a multiple of 8, found ";
  CHECK(error_of(kMinimal + "map: {size_xy: many}\n") == "FILE:5: " + expected + "'many'");
  CHECK(error_of(kMinimal + "map: {size_xy: 256.0}\n") == "FILE:5: " + expected + "'256.0'");
  CHECK(error_of(kMinimal + "map: {size_xy: \"256\"}\n") == "FILE:5: " + expected + "the string '256'");
  CHECK(error_of(kMinimal + "map: {size_xy: }\n") == "FILE:5: " + expected + "nothing");
  CHECK(error_of(kMinimal + "map: {size_xy: [1, 2]}\n") == "FILE:5: " + expected + "a list of 2");
  CHECK(error_of(kMinimal + "map: {size_xy: 0x100}\n") == "FILE:5: " + expected + "'0x100'");
  CHECK(error_of(kMinimal, {"map.size_xy=99999999999"}) ==
        "--set map.size_xy=99999999999: " + expected + "'99999999999'");
  CHECK_THAT(error_of(kMinimal + "map: 3\n"), Contains("FILE:5: map: expected a mapping of keys"));
  CHECK_THAT(error_of(kMinimal + "name2: x\n"), Contains("FILE:5: name2"));
  CHECK_THAT(error_of(kMinimal + "vehicle: {body_min_m: [1, 2]}\n"), Contains("a list [x, y, z]"));
  CHECK_THAT(error_of(kMinimal, {"odometry.source=[a]"}), Contains("expected one line of text"));
  CHECK_THAT(error_of("- a\n- b\n"), Contains("FILE:1: expected a mapping"));
}

TEST_CASE("values out of range are refused") {
  CHECK_THAT(error_of(kMinimal, {"map.resolution_xy_m=0"}),
             Contains("expected a number in 0.01 .. 10, found '0'"));
  CHECK_THAT(error_of(kMinimal, {"map.resolution_xy_m=.nan"}), Contains("expected a number"));
  CHECK_THAT(error_of(kMinimal, {"map.resolution_xy_m=nan"}), Contains("expected a number"));
  CHECK_THAT(error_of(kMinimal, {"window.max_age_s=inf"}), Contains("expected a number"));
  CHECK_THAT(error_of(kMinimal, {"map.size_xy=100"}), Contains("a multiple of 8"));
  CHECK_THAT(error_of(kMinimal, {"layers.plane_size=4"}), Contains("odd"));
  CHECK_THAT(error_of(kMinimal, {"cost.slope_full_rad=0"}), Contains("above 0 .. 1.5708"));
  CHECK_THAT(error_of(kMinimal, {"name=Big Name"}), Contains("a name of [a-z0-9_], 1 to 31 characters"));
  CHECK_THAT(error_of(kMinimal, {"name=" + std::string(32, 'a')}), Contains("1 to 31 characters"));
  CHECK(loaded(kMinimal, {"name=" + std::string(31, 'a')}).name.size() == 31);
}

TEST_CASE("a back end is chosen by its word") {
  const auto defaults = loaded(kMinimal);
  CHECK(defaults.fusion.backend == Backend::cpu);
  CHECK(defaults.lidars[0].backend == Backend::cpu);
  const auto config =
      loaded(kMinimal + "    backend: auto\nfusion: {backend: 'auto'}\n", {"lidars.top.backend=cuda"});
  CHECK(config.fusion.backend == Backend::automatic);
  CHECK(config.lidars[0].backend == Backend::cuda);
  CHECK(loaded(kMinimal + "    backend: auto\n").lidars[0].backend == Backend::automatic);

  const std::string expected = "backend: expected one of auto, cpu, cuda, found ";
  CHECK(error_of(kMinimal + "fusion: {backend: gpu}\n") == "FILE:5: fusion." + expected + "'gpu'");
  CHECK(error_of(kMinimal + "    backend: CUDA\n") == "FILE:5: lidars.top." + expected + "'CUDA'");
  CHECK(error_of(kMinimal, {"fusion.backend="}) == "--set fusion.backend=: fusion." + expected + "''");
  CHECK(error_of(kMinimal, {"fusion.backend=[cpu]"}) ==
        "--set fusion.backend=[cpu]: fusion." + expected + "a list of 1");
}

TEST_CASE("keys that contradict each other are refused") {
  CHECK(error_of(kMinimal + "    min_range_m: 5\n    max_range_m: 5\n") ==
        "FILE:6: lidars.top.max_range_m: expected more than min_range_m");
  CHECK_THAT(error_of(kMinimal, {"lidars.top.min_range_m=200"}),
             Contains("--set lidars.top.min_range_m=200: lidars.top.max_range_m"));
  CHECK_THAT(error_of(kMinimal, {"layers.max_obstacle_height_m=0.5"}),
             Contains("more than min_obstacle_height_m"));
  CHECK_THAT(error_of(kMinimal, {"cost={soft_weight: 0, slope_weight: 0, roughness_weight: 0}"}),
             Contains("cost.soft_weight: expected one of the three weights above 0"));
  CHECK_THAT(error_of(kMinimal, {"vehicle={body_min_m: [0, 0, 0], body_max_m: [1, 0, 1]}"}),
             Contains("more than body_min_m on each axis"));
}

TEST_CASE("lidars that are too many or badly named are refused") {
  std::string yaml = "name: v\nlidars:\n";
  for (int i = 0; i < 17; ++i) {
    yaml += "  l" + std::to_string(i) + ": {T_base_sensor: {x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}}\n";
  }
  CHECK(error_of(yaml) == "FILE:2: lidars: expected 1 to 16 lidars, found 17");
  CHECK_THAT(error_of("name: v\nlidars: {Top: {}}\n"),
             Contains("FILE:2: lidars.Top: expected a lidar's name"));
  CHECK_THAT(error_of("name: v\nlidars: {a.b: {}}\n"), Contains("expected a lidar's name"));
  CHECK_THAT(error_of(kMinimal, {"lidars.tpo.source=x"}), Contains("no lidar 'tpo' in FILE, which has: top"));
}

TEST_CASE("what is no vehicle file at all is refused") {
  const auto absent = load_vehicle_config("/nonexistent/vehicle.yaml");
  REQUIRE_FALSE(absent);
  CHECK(absent.error().text() == "/nonexistent/vehicle.yaml: No such file or directory");
  const auto folder = load_vehicle_config("/tmp");
  REQUIRE_FALSE(folder);
  CHECK(folder.error().text() == "/tmp: Is a directory");
  CHECK(error_of("") == "FILE: is empty");
  CHECK_THAT(error_of("name: [1\n"), Contains("not YAML"));
  CHECK_THAT(error_of(kMinimal + "---\n" + kMinimal), Contains("one YAML document, found more"));
  CHECK_THAT(error_of("# nothing\n"), Contains("one YAML document, found none"));
  CHECK_THAT(error_of(",a: b\n"), Contains("one YAML document, found more"));  // yaml-cpp: without end
  CHECK_THAT(error_of(kMinimal, {"map.size_xy"}), Contains("--set map.size_xy: expected KEY=VALUE"));
  CHECK_THAT(error_of(kMinimal, {"=3"}), Contains("expected KEY=VALUE"));
  CHECK_THAT(error_of(kMinimal, {"map.size_xy=[1"}), Contains("--set map.size_xy=[1: map.size_xy: not YAML"));
}

TEST_CASE("a lidar is found by its name or the names there are get listed") {
  const auto config = loaded(kMinimal);
  CHECK(services::find_lidar(config, "top").value() == &config.lidars[0]);
  const auto absent = services::find_lidar(config, "rear");
  REQUIRE_FALSE(absent);
  CHECK_THAT(absent.error().text(), Contains("no lidar 'rear', there is: top"));
}
