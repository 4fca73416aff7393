// The common command line: what goes to stdout, what to stderr, and the exit code.
#include <catch2/catch.hpp>

#include <iostream>
#include <sstream>

#include "services/common/cli.hpp"
#include "tests/common/temporary_file.hpp"

namespace {

using namespace gvom;
using Catch::Contains;
using services::Cli;
using services::ExitCode;

const std::string kKitti = GVOM_SOURCE_DIR "/config/vehicles/kitti.yaml";

/// What is written to a stream while this lives.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* before_;
};

struct Result {
  int code = -1;  // -1: the configuration was loaded and the program would go on
  std::string out;
  std::string err;
  services::VehicleConfig config;
  std::string lidar;
};

Result run(const std::vector<std::string>& arguments) {
  Result result;
  Cli cli("gvom-test", "Tests.");
  cli.app().add_option("--lidar", result.lidar);
  cli.also_check([&](const services::VehicleConfig& config) -> tl::expected<void, services::ConfigError> {
    if (result.lidar.empty()) return {};
    return services::find_lidar(config, result.lidar).map([](const services::LidarConfig*) {});
  });
  std::vector<const char*> argv = {"gvom-test"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  const Captured out(std::cout);
  const Captured err(std::cerr);
  const auto config = cli.parse(static_cast<int>(argv.size()), argv.data());
  result.out = out.text();
  result.err = err.text();
  if (config) {
    result.config = *config;
  } else {
    result.code = to_int(config.error());
  }
  return result;
}

}  // namespace

TEST_CASE("a good command line gives the configuration") {
  const Result result = run({"--config", kKitti, "--lidar", "top", "--set", "map.size_xy=64", "--set",
                             "lidars.top.source=scans:d", "--set=vehicle.radius_m=3"});
  CHECK(result.code == -1);
  CHECK(result.out + result.err == "");
  CHECK(result.lidar == "top");
  CHECK(result.config.mapper.map.size_xy == 64);
  CHECK(result.config.mapper.vehicle.radius_m == 3.0);
  CHECK(result.config.lidars[0].source == "scans:d");
}

TEST_CASE("--help and --version need no configuration") {
  const Result help = run({"--help"});
  CHECK(help.code == 0);
  for (const char* flag : {"--config", "--check", "--print-config", "--set", "--version", "--lidar"}) {
    CHECK_THAT(help.out, Contains(flag));
  }
  const Result version = run({"--version"});
  CHECK(version.code == 0);
  CHECK_THAT(version.out, Catch::StartsWith("gvom-test "));
}

TEST_CASE("--check says OK or what is wrong") {
  CHECK(run({"--config", kKitti, "--check"}).out == "OK\n");
  CHECK(run({"--config", kKitti, "--check"}).code == 0);
  const Result bad = run({"--config", kKitti, "--check", "--set", "map.size=8"});
  CHECK(bad.code == 78);
  CHECK(bad.out == "");
  CHECK(bad.err == "--set map.size=8: map.size: unknown key, did you mean map.size_z?\n");
}

TEST_CASE("an executable's own check is part of it") {
  const Result result = run({"--config", kKitti, "--check", "--lidar", "rear"});
  CHECK(result.code == 78);
  CHECK(result.err == kKitti + ": lidars: no lidar 'rear', there is: top\n");
}

TEST_CASE("--print-config prints a file that loads") {
  const Result result = run({"--config", kKitti, "--print-config", "--set", "map.size_xy=64"});
  CHECK(result.code == 0);
  const test::TemporaryFile file(result.out);
  const auto again = services::load_vehicle_config(file.path());
  REQUIRE(again);
  CHECK(again->mapper.map.size_xy == 64);
}

TEST_CASE("wrong usage is 64, a wrong configuration 78") {
  CHECK(run({}).code == 64);
  CHECK(run({"--config"}).code == 64);
  CHECK(run({"--config", kKitti, "--frobnicate"}).code == 64);
  CHECK(run({"--config", kKitti, "stray"}).code == 64);
  CHECK(run({"--config", kKitti, "--set", "map.size_xy=64", "stray"}).code == 64);
  CHECK(run({"--config", "/nonexistent.yaml"}).code == 78);
  CHECK(run({"--config", kKitti, "--set", "map.size_xy"}).code == 78);
}
